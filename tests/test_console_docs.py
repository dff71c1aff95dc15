"""The console commands of these pages run and print what the page shows.

A block ``python NAME`` or ``yaml NAME`` is a file of that name. In a ``console`` block,
lines with ``$`` are commands; the other lines are the expected output on stdout and
stderr. Runs of spaces count as one; a line ``…`` matches any number of lines, ``…``
within a line any text.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```", re.DOTALL | re.MULTILINE)
PAGES = [
    "tutorials/3-distance.md",
    pytest.param(
        "tutorials/5-map-and-localise.md",
        marks=[pytest.mark.long, pytest.mark.timeout(600)],
    ),
    pytest.param("howto/launch.md", marks=pytest.mark.long),
    "howto/localise.md",
    "howto/play.md",
]


def commands(block: str) -> list[tuple[str, list[str]]]:
    """Return each command with its expected output lines."""
    found: list[tuple[str, list[str]]] = []
    for line in block.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        else:
            found[-1][1].append(" ".join(line.split()))
    return found


def matches(expected: list[str], printed: list[str]) -> bool:
    if not expected:
        return not printed
    if expected[0] == "…":
        return any(
            matches(expected[1:], printed[at:]) for at in range(len(printed) + 1)
        )
    return (
        bool(printed)
        and matches_line(expected[0], printed[0])
        and matches(expected[1:], printed[1:])
    )


def matches_line(expected: str, printed: str) -> bool:
    parts = map(re.escape, expected.split("…"))
    return re.fullmatch(".*".join(parts), printed) is not None


# Runs all commands in one process, because most of their time is imports.
RUNNER = """
import json, os, runpy, shlex, sys, traceback
from navette.cli import main

for number, command in enumerate(json.loads(sys.argv[1])):
    program, *sys.argv = shlex.split(command)
    with open(f"output-{number}", "wb") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    try:
        if program == "navette":
            sys.argv.insert(0, program)
            main()
        else:
            runpy.run_path(sys.argv[0], run_name="__main__")
    except SystemExit:
        pass
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
"""


def run(all_commands: list[str], folder: Path) -> list[list[str]]:
    """Return the output lines of each command."""
    words = [sys.executable, "-X", "utf8", "-c", RUNNER, json.dumps(all_commands)]
    env = {**os.environ, "NAVETTE_TRANSPORT": "inprocess"}
    subprocess.run(words, cwd=folder, env=env, timeout=600, check=True)
    texts = [
        (folder / f"output-{number}").read_text(encoding="utf-8")
        for number in range(len(all_commands))
    ]
    return [[" ".join(line.split()) for line in text.splitlines()] for text in texts]


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_commands_print_what_the_page_shows(page: str, tmp_path: Path) -> None:
    for recording in (ROOT / "examples" / "data").glob("*.mcap"):
        shutil.copy(recording, tmp_path)
    expected_outputs: list[tuple[str, list[str]]] = []
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    for kind, name, block in BLOCK.findall(text):
        if name:
            (tmp_path / name).write_text(block, encoding="utf-8")
        elif kind == "console":
            expected_outputs += commands(block)
    outputs = run([command for command, _ in expected_outputs], tmp_path)
    for (command, expected), printed in zip(expected_outputs, outputs, strict=True):
        assert matches(expected, printed), "\n".join([f"$ {command}", *printed])
