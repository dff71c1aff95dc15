"""Pages whose commands are run as they are printed, and say what is printed.

A block ``python NAME`` or ``yaml NAME`` is a file of that name; in a block ``console``
a line that begins with ``$`` is run, the others are what it says on both outputs, but
for the width of spaces; ``…`` alone stands for any number of lines.
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
PAGES = ["tutorials/3-distance.md", "howto/localise.md", "howto/play.md"]


def commands(block: str) -> list[tuple[str, list[str]]]:
    """Each command with the lines that it is to say."""
    found: list[tuple[str, list[str]]] = []
    for line in block.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], []))
        else:
            found[-1][1].append(" ".join(line.split()))
    return found


def matches(expected: list[str], said: list[str]) -> bool:
    if not expected:
        return not said
    if expected[0] == "…":
        return any(matches(expected[1:], said[at:]) for at in range(len(said) + 1))
    return bool(said) and expected[0] == said[0] and matches(expected[1:], said[1:])


# Runs the commands one after the other, in one process: most of their time is imports.
RUNNER = """
import json, os, runpy, shlex, sys, traceback
from navette.cli import main

for number, command in enumerate(json.loads(sys.argv[1])):
    program, *sys.argv = shlex.split(command)
    with open(f"said-{number}", "wb") as file:
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
    """What each command says on both outputs, line by line."""
    words = [sys.executable, "-X", "utf8", "-c", RUNNER, json.dumps(all_commands)]
    env = {**os.environ, "NAVETTE_TRANSPORT": "inprocess"}
    subprocess.run(words, cwd=folder, env=env, timeout=120, check=True)
    texts = [
        (folder / f"said-{number}").read_text(encoding="utf-8")
        for number in range(len(all_commands))
    ]
    return [[" ".join(line.split()) for line in text.splitlines()] for text in texts]


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_say_what_it_says(page: str, tmp_path: Path) -> None:
    for recording in (ROOT / "examples" / "data").glob("*.mcap"):
        shutil.copy(recording, tmp_path)
    wanted: list[tuple[str, list[str]]] = []
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    for kind, name, block in BLOCK.findall(text):
        if name:
            (tmp_path / name).write_text(block, encoding="utf-8")
        elif kind == "console":
            wanted += commands(block)
    outputs = run([command for command, _ in wanted], tmp_path)
    for (command, expected), said in zip(wanted, outputs, strict=True):
        assert matches(expected, said), "\n".join([f"$ {command}", *said])
