"""Pages whose commands are run as they are printed, and say what is printed.

A block ``python NAME`` or ``yaml NAME`` is a file of that name; in a block ``console``
a line that begins with ``$`` is run, the others are what it says on both outputs, but
for the width of spaces; ``…`` alone stands for any number of lines.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
BLOCK = re.compile(r"^```(\w+)(?: (\S+))?\n(.*?)^```", re.DOTALL | re.MULTILINE)
PAGES = ["tutorials/3-distance.md", "howto/localise.md"]


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


def run(command: str, folder: Path) -> list[str]:
    programs = str(Path(sys.executable).parent)
    done = subprocess.run(
        command,
        shell=True,
        cwd=folder,
        env={
            **os.environ,
            "PATH": programs + os.pathsep + os.environ.get("PATH", ""),
            "PYTHONUTF8": "1",
            "NAVETTE_TRANSPORT": "inprocess",
        },
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        timeout=60,
        check=False,
    )
    return [" ".join(line.split()) for line in done.stdout.splitlines()]


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_say_what_it_says(page: str, tmp_path: Path) -> None:
    for recording in (ROOT / "examples" / "data").glob("*.mcap"):
        shutil.copy(recording, tmp_path)
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    for kind, name, block in BLOCK.findall(text):
        if name:
            (tmp_path / name).write_text(block, encoding="utf-8")
        elif kind == "console":
            for command, expected in commands(block):
                said = run(command, tmp_path)
                assert matches(expected, said), "\n".join([f"$ {command}", *said])
