"""The shells' own view of completion: scripts in a real bash, zsh and fish.

They ask a stand-in for ``navette`` that knows a few words.
"""

import os
import pty
import select
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

import pytest

from navette.cli.completion import SCRIPTS

STAND_IN = r"""#!/bin/sh
asked="${_TYPER_COMPLETE_ARGS:-$(echo $COMP_WORDS | sed 's/.* //')}"
case "$_NAVETTE_COMPLETE $asked" in
  *" topic ") printf 'list\tThe topics: all.\necho\tMessages.\n' ;;
  *"/od") printf '/odom/filtered\n' ;;
  complete_bash*Twist) printf "\"{x: 0.0, s: ''}\"\n" ;;
  *"Twist ") printf "{x: 0.0, s: ''}\n" ;;
esac
"""
LIMIT_S = 30.0


def needs(shell: str) -> pytest.MarkDecorator:
    return pytest.mark.skipif(not shutil.which(shell), reason=f"needs {shell}")


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    program = tmp_path / "navette"
    program.write_text(STAND_IN)
    program.chmod(0o755)
    for shell, script in SCRIPTS.items():
        (tmp_path / f"script.{shell}").write_text(script)
    path = f"{tmp_path}{os.pathsep}{os.environ['PATH']}"
    return {"PATH": path, "HOME": str(tmp_path), "TERM": "dumb", "LC_ALL": "C.UTF-8"}


def said(environment: Mapping[str, str], *command: str) -> str:
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
        (("topic", "echo", "/od"), "/odom/filtered"),
        (("topic", "pub", "/x", "Twist", ""), "\"{x: 0.0, s: ''}\""),
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
    assert said(environment, "bash", "--norc", "-c", body) == offered


@needs("fish")
@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("navette topic ", "echo\tMessages.\nlist\tThe topics: all.\n"),
        ("navette topic echo /od", "/odom/filtered\n"),
        ("navette topic pub /x Twist ", "{x: 0.0, s: ''}\n"),
    ],
)
def test_fish(environment: dict[str, str], line: str, offered: str) -> None:
    body = f"source script.fish; complete -C '{line}'"
    assert said(environment, "fish", "--no-config", "-c", body) == offered


@needs("zsh")
def test_zsh(environment: dict[str, str]) -> None:
    """Zsh completes only what is typed at a terminal."""
    setup = "autoload -Uz compinit; compinit -D -u; source ./script.zsh; echo re''ady\r"
    with Typing(["zsh", "-f", "-i"], environment) as zsh:
        zsh.type(setup, until="ready")
        zsh.type("navette topic \t", until="list  -- The topics: all.")
        zsh.type("\x15navette topic echo /od\t", until="/odom/filtered")
        zsh.type("\x15navette topic pub /x Twist \t", until="Twist \"{x: 0.0, s: ''}\"")


class Typing:
    """A program at a terminal of its own."""

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
        """Type, and read until that text is there."""
        os.write(self._terminal, keys.encode())
        seen = ""
        while until not in seen:
            there, _, _ = select.select([self._terminal], [], [], LIMIT_S)
            assert there, f"no {until!r} in {seen!r}"
            seen += os.read(self._terminal, 65536).decode(errors="replace")
