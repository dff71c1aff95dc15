"""Every example runs, with warnings as errors, and prints what it says."""

import ast
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("*.py"))


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_an_example_prints_what_it_says(example: Path) -> None:
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


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 9
    assert all(
        len(example.read_text(encoding="utf-8").splitlines()) <= 60
        for example in EXAMPLES
    )
