"""Methods of the user: found by place, checked, made from parameters, faults named."""

import importlib.metadata
from dataclasses import dataclass
from pathlib import Path
from textwrap import dedent
from typing import Any

import numpy as np
import pytest

from navette.errors import InvalidValueError, ParameterError, UnknownNameError
from navette.params import Params, param
from navette.params.plugins import (
    MethodFaultError,
    MethodRegistry,
    checked_array,
    own_call,
    with_methods,
)
from navette.params.plugins.registry import _installed

SHAPES = MethodRegistry("shape", "navette.test_shapes", {"area": ("width", "height")})


@SHAPES.register("box")
class BoxShape:
    def area(self, width: float, height: float) -> float:
        return width * height


@dataclass(frozen=True, kw_only=True)
class ShapeParams(Params):
    method: str = param("box", "shape", choices=SHAPES)
    scale_m: float = param(2.0, "scale", unit="m", above=0.0)


def written(folder: Path, text: str, name: str = "mine.py") -> str:
    path = folder / name
    path.write_text(dedent(text), encoding="utf-8")
    return str(path)


def test_a_class_gets_its_dataclass_with_the_stages_values(tmp_path: Path) -> None:
    place = written(
        tmp_path,
        """
        from dataclasses import dataclass
        from navette.params import param

        class Mine:
            @dataclass
            class Params:
                gain: float = param(3.0, "gain", unit="1/m", at_least=0.0)
                scale_m: float = 9.0

            def __init__(self, params):
                self.params = params

            def area(self, width, height):
                return self.params.gain * self.params.scale_m * width * height
        """,
    )
    kind = with_methods(ShapeParams, {"method": f"{place}:Mine"})
    params: Any = kind(method=f"{place}:Mine", scale_m=5.0, gain=4)
    assert SHAPES.load(params.method).make(params).area(1.0, 2.0) == 40.0
    with pytest.raises(ParameterError, match=r"'gain': -1\.0 .*>= 0 1/m"):
        kind(method=f"{place}:Mine", gain=-1.0)


def test_a_dataclass_is_its_own_parameters_and_a_function_has_none(
    tmp_path: Path,
) -> None:
    place = written(
        tmp_path,
        """
        from __future__ import annotations
        from dataclasses import dataclass

        @dataclass
        class Mine:
            gain: float = 3.0

            def area(self, width, height):
                return self.gain * width * height

        def half(width, height):
            return width * height / 2
        """,
    )
    kind: Any = with_methods(ShapeParams, {"method": f"{place}:Mine"})
    params = kind(method=f"{place}:Mine", gain=2.0)
    assert SHAPES.load(params.method).make(params).area(1.0, 2.0) == 4.0
    assert SHAPES.load(f"{place}:half").make(ShapeParams()).area(1.0, 2.0) == 1.0
    assert SHAPES.load(place).target.__name__ == "Mine"


@pytest.mark.parametrize(
    ("text", "name", "match"),
    [
        ("class Mine:\n    def run(self): ...", ":Mine", r"line|:1\).*no method "
         r"area\(width, height\); it has: run"),
        ("class Mine:\n    def area(self, width): ...", ":Mine",
         r"mine.py:1\): area\(self, width\) cannot be called as area\(width, height\)"),
        ("class Mine:\n    def area(self, w, h): ...", ":Other", "known: Mine"),
        ("x = 1 / 0", ":Mine", r"cannot be imported: ZeroDivisionError \(line 1\)"),
        ("class Mine:\n    def area(self, w, h): ...", ":Mien", "shape .*unknown name"),
        ("def area(:", ":Mine", r"cannot be imported: SyntaxError \(line 1\)"),
        ("import not_there_at_all", ":Mine", "ModuleNotFoundError.*not_there_at_all"),
        ("area = 3", ":area", "of type int; expected a class with area"),
        ("x = 1", "", "no classes with area"),
        ("def area(w, h): ...\nclass A:\n    def area(self, w, h): ...", "",
         "several classes .*there are: area, A"),
    ],
)  # fmt: skip
def test_errors_name_file_class_and_what_is_wrong(
    tmp_path: Path, text: str, name: str, match: str
) -> None:
    place = written(tmp_path, text) + name
    with pytest.raises(ParameterError, match=f"(?s)parameter 'method': .*{match}"):
        with_methods(ShapeParams, {"method": place})


@pytest.mark.parametrize(
    ("place", "match"),
    [
        ("circle", "unknown shape 'circle'; known: box; your own: FILE.py:NAME"),
        ("nowhere.py:Mine", "shape nowhere.py:Mine: nowhere.py: no such file in /"),
        ("no_such_module_x:Mine", "'no_such_module_x' is not installed"),
    ],
)
def test_unknown_places_are_refused(place: str, match: str) -> None:
    with pytest.raises(UnknownNameError, match=match):
        SHAPES.load(place)


def test_fields_that_cannot_be_parameters_are_refused(tmp_path: Path) -> None:
    text = """
        from dataclasses import dataclass

        @dataclass
        class Mine:
            gains: {kind}

            def area(self, width, height): ...
        """
    place = written(tmp_path, text.format(kind="list"), "a.py")
    with pytest.raises(ParameterError, match=r"'gains' of Mine is of type list; .*"):
        with_methods(ShapeParams, {"method": place})
    place = written(tmp_path, text.format(kind="float"), "b.py")
    with pytest.raises(ParameterError, match="'gains' of Mine has no default"):
        with_methods(ShapeParams, {"method": place})


def test_installed_packages_offer_methods_by_entry_points(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written(tmp_path, "def area(width, height): return 7.0", "shapes_of_a_package.py")
    info = tmp_path / "shapes_of_a_package-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Name: shapes_of_a_package\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[navette.test_shapes]\nseven = shapes_of_a_package:area\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    importlib.invalidate_caches()
    _installed.cache_clear()
    assert "seven" in SHAPES
    assert SHAPES.load("seven").make(ShapeParams()).area(1, 1) == 7.0
    assert ShapeParams(method="seven").method == "seven"
    _installed.cache_clear()


def test_a_name_is_registered_once() -> None:
    with pytest.raises(InvalidValueError, match="shape 'box' is registered already"):
        SHAPES.register("box")(BoxShape)


def test_a_fault_has_the_users_own_lines(tmp_path: Path) -> None:
    place = written(tmp_path, "def area(w, h):\n    return w / h\n")
    area = SHAPES.load(place).make(ShapeParams()).area
    with pytest.raises(MethodFaultError) as caught:
        own_call("shape mine", area, 1.0, 0.0)
    text = str(caught.value)
    assert text.startswith("shape mine raised ZeroDivisionError: float division")
    assert "mine.py" in text
    assert "line 2" in text
    assert "return w / h" in text
    assert "own_call" not in text


@pytest.mark.parametrize(
    ("value", "match"),
    [
        ("fast", "returned str 'fast'; expected two numbers"),
        (None, "returned NoneType|returned nan|shape"),
        ([1.0], r"shape \(1,\); expected two numbers"),
        (0.5, r"returned 0.5 alone; expected two numbers"),
        ([1.0, np.nan], "returned nan at index 1; expected two numbers, all finite"),
    ],
)
def test_wrong_results_are_named(value: Any, match: str) -> None:
    with pytest.raises(MethodFaultError, match=match):
        checked_array("shape mine", value, "two numbers", lambda s: s == (2,))
