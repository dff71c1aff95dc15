"""Examples and how-to pages run and print what they promise."""

import ast
import contextlib
import io
import math
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

ROOT = Path(__file__).parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
HOW_TO = ROOT / "docs" / "howto"
BLOCK = re.compile(r"```(\w+)\n(.*?)```", re.DOTALL)


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_example_output_matches_its_docstring(example: Path) -> None:
    head = ast.get_docstring(ast.parse(example.read_text(encoding="utf-8")))
    assert head is not None
    promised = textwrap.dedent(head.partition("Prints::\n\n")[2])
    done = subprocess.run(
        [sys.executable, "-W", "error", "-X", "utf8", str(example)],
        capture_output=True,
        encoding="utf-8",
        timeout=120,
    )
    assert done.stderr == ""
    assert done.returncode == 0
    assert done.stdout == promised + "\n"


def test_examples_are_short() -> None:
    assert len(EXAMPLES) >= 22
    assert all(
        len(example.read_text(encoding="utf-8").splitlines()) <= 110
        for example in EXAMPLES
    )


def blocks(page: str, language: str) -> list[str]:
    text = (HOW_TO / page).read_text(encoding="utf-8")
    return [block for kind, block in BLOCK.findall(text) if kind == language]


@pytest.mark.slow
@pytest.mark.parametrize("page", ["parameters.md", "own-robot.md"])
def test_how_to_output_matches_the_page(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for model in blocks(page, "xml"):
        Path("cart.sdf").write_text(model)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        for program in blocks(page, "python"):
            exec(compile(program, page, "exec"), {})
    assert printed.getvalue() == "".join(blocks(page, "text"))


@pytest.mark.slow
def test_robot_of_the_how_to_drives(tmp_path: Path) -> None:
    (model,), (parameters,) = (
        blocks("own-robot.md", "xml"),
        blocks("own-robot.md", "yaml"),
    )
    (tmp_path / "cart.sdf").write_text(model)
    (tmp_path / "cart.yaml").write_text(parameters)
    options = RunOptions(
        robot=str(tmp_path / "cart.sdf"),
        params_files=(tmp_path / "cart.yaml",),
        goals=((-4.0, -7.5),),
        headless=True,
        speed=math.inf,
    )
    simulation = Simulation(options)
    simulation.run()
    simulation.close()
    assert simulation.summary().succeeded
    assert simulation.stack.control.params.cruise_speed_mps == 0.5
