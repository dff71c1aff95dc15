"""Shell completion of the installed command, in a real bash, zsh and fish."""

import os
import pty
import select
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from navette.cli.completion import SHELLS, script_of

NAVETTE = f"""#!/bin/sh
exec {sys.executable} -m navette "$@"
"""
VALUES = "std_msgs/msg/ColorRGBA"
LIMIT_S = 30.0


def needs(shell: str) -> pytest.MarkDecorator:
    return pytest.mark.skipif(not shutil.which(shell), reason=f"needs {shell}")


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    program = tmp_path / "navette"
    program.write_text(NAVETTE)
    program.chmod(0o755)
    for shell in SHELLS:
        (tmp_path / f"script.{shell}").write_text(script_of(shell))
    path = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    return {
        "PATH": path,
        "HOME": str(tmp_path),
        "TERM": "dumb",
        "LC_ALL": "C.UTF-8",
        "NAVETTE_TRANSPORT": "inprocess",
    }


def output(environment: Mapping[str, str], *command: str) -> str:
    done = subprocess.run(
        command,
        env=environment,
        cwd=environment["HOME"],
        capture_output=True,
        text=True,
        check=True,
        timeout=LIMIT_S,
    )
    return done.stdout


@needs("bash")
@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (("topic", "ec"), "echo"),
        (("topic", "echo", "/x", "--qos-reliability", "be"), "best_effort"),
        (("topic", "pub", "/x", VALUES, ""), '"{r: 0.0, g: 0.0, b: 0.0, a: 0.0}"'),
        (("sim", "file"), ""),
    ],
)
def test_bash(
    environment: dict[str, str], words: tuple[str, ...], offered: str
) -> None:
    typed = " ".join(f"'{word}'" for word in ("navette", *words))
    body = (
        f"source ./script.bash; COMP_WORDS=({typed}); COMP_CWORD={len(words)};"
        '_navette_completion navette; printf "%s" "${COMPREPLY[@]}"'
    )
    assert output(environment, "bash", "--norc", "-c", body) == offered


@needs("fish")
@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("navette lifecycle ge", "get\tPrint the state"),
        ("navette topic echo /x --qos-reliability be", "best_effort\n"),
        (f"navette topic pub /x {VALUES} ", "{r: 0.0, g: 0.0, b: 0.0, a: 0.0}\n"),
    ],
)
def test_fish(environment: dict[str, str], line: str, offered: str) -> None:
    body = f"source script.fish; complete -C '{line}'"
    assert output(environment, "fish", "--no-config", "-c", body).startswith(offered)


@needs("zsh")
def test_zsh(environment: dict[str, str]) -> None:
    """zsh completes only at a terminal."""
    setup = "autoload -Uz compinit; compinit -D -u; source ./script.zsh; echo re''ady\r"
    with Typing(["zsh", "-f", "-i"], environment) as zsh:
        zsh.type(setup, until="ready")
        zsh.type("navette topic ec\t", until="echo ")
        zsh.type("\x15navette topic echo /x --qos-reliability b\t", until="best_effort")
        zsh.type(f"\x15navette topic pub /x {VALUES} \t", until=r"0.0,\ b:\ 0.0")


class Typing:
    """A program with its own terminal."""

    def __init__(self, command: list[str], environment: Mapping[str, str]) -> None:
        self._terminal, its_end = pty.openpty()
        self._program = subprocess.Popen(
            command,
            env=environment,
            cwd=environment["HOME"],
            stdin=its_end,
            stdout=its_end,
            stderr=its_end,
            start_new_session=True,
        )
        os.close(its_end)

    def __enter__(self) -> "Typing":
        return self

    def __exit__(self, *_: object) -> None:
        self._program.kill()
        self._program.wait(LIMIT_S)
        os.close(self._terminal)

    def type(self, keys: str, *, until: str) -> None:
        """Type keys and read until the text appears."""
        os.write(self._terminal, keys.encode())
        seen = ""
        while until not in seen:
            there, _, _ = select.select([self._terminal], [], [], LIMIT_S)
            assert there, f"no {until!r} in {seen!r}"
            seen += os.read(self._terminal, 65536).decode(errors="replace")
