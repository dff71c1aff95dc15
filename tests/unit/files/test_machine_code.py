"""Stored kernels: what is read of them, and kernels that are compiled with them."""

from pathlib import Path
from types import FunctionType
from typing import Any

import pytest

from navette.files import kernels
from navette.files.machine_code import StoredLibrary


def hypotenuse(a: float, b: float) -> float:
    """A kernel that can raise, whose environment has constants."""
    if a < 0.0:
        raise ValueError("a is negative")
    return (a * a + b * b) ** 0.5


length: Any = None  # a kernel among the globals of a caller


def twice(a: float) -> float:
    double: float = 2.0 * length(a, 4.0)
    return double


@pytest.fixture
def stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a kernel whose machine code another one has stored."""
    monkeypatch.setattr(kernels, "_folder", lambda: tmp_path)
    assert kernels.kernel(_with_globals(hypotenuse))(3.0, 4.0) == 5.0
    assert len(list(tmp_path.glob("*.kernel"))) == 1
    kernel: Any = kernels.kernel(_with_globals(hypotenuse))
    assert kernel(3.0, 4.0) == 5.0
    assert sum(kernel.stats.cache_hits.values()) == 1
    return kernel


def _with_globals(function: Any, **values: object) -> Any:
    """Return a function as another process would have it, with these globals."""
    scope = {"__name__": __name__, **values}
    return FunctionType(function.__code__, scope, function.__name__)


def library(kernel: Any) -> StoredLibrary:
    (compiled,) = kernel.overloads.values()
    assert isinstance(compiled.library, StoredLibrary)
    return compiled.library


def test_bitcode_is_parsed_when_a_caller_is_compiled(stored: Any) -> None:
    assert library(stored)._shared_module is None

    caller = kernels.kernel(_with_globals(twice, length=stored))
    assert caller(3.0) == 10.0
    assert library(stored)._shared_module is not None
    assert stored(5.0, 12.0) == 13.0


def test_functions_of_stored_machine_code_are_found(stored: Any) -> None:
    found = library(stored)
    (compiled,) = stored.overloads.values()
    assert found.get_pointer_to_function(compiled.fndesc.llvm_func_name)
    assert found.get_pointer_to_function("no_such_function") == 0


def test_stored_kernels_raise_their_errors(stored: Any) -> None:
    with pytest.raises(ValueError, match="a is negative"):
        stored(-1.0, 4.0)
