"""Examples and how-to pages run and print what they promise."""

import ast
import contextlib
import io
import json
import math
import os
import re
import signal
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path

import pytest

from navette.navigation.stack import RunOptions
from navette.navigation.stack.simulation import Simulation

ROOT = Path(__file__).parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
HOW_TO = ROOT / "docs" / "howto"
BLOCK = re.compile(r"```(\w+)\n(.*?)```", re.DOTALL)


# Imports once and forks for each example: most of their time would be imports.
SERVER = """
import json, os, runpy, sys
import navette.navigation.stack.simulation
for line in sys.stdin:
    example, *outputs = json.loads(line)
    child = os.fork()
    if not child:
        for descriptor, output in enumerate(outputs, start=1):
            os.dup2(os.open(output, os.O_WRONLY | os.O_CREAT), descriptor)
        sys.argv[:] = [example]
        sys.path[0] = os.path.dirname(example)
        runpy.run_path(example, run_name="__main__")
        break
    _, status = os.waitpid(child, 0)
    print(os.waitstatus_to_exitcode(status), flush=True)
"""


class Examples:
    """Runs examples, each in a process of its own."""

    def __init__(self, folder: Path) -> None:
        self._outputs = [folder / "stdout", folder / "stderr"]
        self._server = subprocess.Popen(
            [sys.executable, "-W", "error", "-X", "utf8", "-c", SERVER],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def run(self, example: Path) -> tuple[int, str, str]:
        """Return exit code, output and errors."""
        assert self._server.stdin is not None
        assert self._server.stdout is not None
        for output in self._outputs:
            output.write_bytes(b"")
        order = json.dumps([str(example), *map(str, self._outputs)])
        self._server.stdin.write(f"{order}\n")
        self._server.stdin.flush()
        code = int(self._server.stdout.readline())
        out, err = (path.read_text(encoding="utf-8") for path in self._outputs)
        return code, out, err

    def close(self) -> None:
        """End the server and an example that has not ended."""
        with self._server:
            os.killpg(self._server.pid, signal.SIGKILL)


@pytest.fixture(scope="module")
def examples(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Examples]:
    made = Examples(tmp_path_factory.mktemp("examples"))
    yield made
    made.close()


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_example_output_matches_its_docstring(
    example: Path, examples: Examples
) -> None:
    head = ast.get_docstring(ast.parse(example.read_text(encoding="utf-8")))
    assert head is not None
    promised = textwrap.dedent(head.partition("Prints::\n\n")[2])
    code, printed, errors = examples.run(example)
    assert errors == ""
    assert code == 0
    assert printed == promised + "\n"


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
@pytest.mark.parametrize("page", ["parameters.md", "own-robot.md", "train.md"])
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
