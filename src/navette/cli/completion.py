"""``navette completion``: shell completion of verbs, topics, nodes and other names.

The scripts are click's: they call ``navette`` with ``_NAVETTE_COMPLETE`` set.
"""

import os
import sys
from pathlib import Path
from typing import Annotated

import click
from click.shell_completion import BashComplete, FishComplete, ZshComplete

from navette.cli.options import Argument, Option
from navette.cli.output import show
from navette.cli.session import fail
from navette.cli.stderr import note

VARIABLE = "_NAVETTE_COMPLETE"


class _FishComplete(FishComplete):
    # Split only the type off: values of messages contain commas.
    source_template = FishComplete.source_template.replace(
        "string split", "string split --max 1"
    )


SHELLS = {"bash": BashComplete, "zsh": ZshComplete, "fish": _FishComplete}

# Read by the shell when it starts.
_SETTINGS = {"bash": ".bashrc", "zsh": ".zshrc"}


def completion(
    shell: Annotated[
        str | None,
        Argument(
            metavar="[bash|zsh|fish]",
            help="Default: the shell in $SHELL.",
            type=click.Choice(list(SHELLS)),
        ),
    ] = None,
    install: Annotated[
        bool, Option("--install", help="Add the script to the shell's settings.")
    ] = False,
) -> None:
    """Print or install the shell completion script.

    For this terminal: [bold]eval "$(navette completion bash)"[/bold]. For all new
    terminals: [bold]navette completion --install[/bold].
    """
    chosen = shell or _current_shell()
    if not install:
        show(script_of(chosen).rstrip("\n"))
        return
    for path in install_script(chosen, Path.home()):
        show(f"wrote {path}")
    note("open a new terminal to use completion")


def _current_shell() -> str:
    name = Path(os.environ.get("SHELL", "")).name
    if name not in SHELLS:
        fail(
            f"$SHELL is {name or 'not set'}: no completion for it; name one of"
            f" {', '.join(SHELLS)}, as in navette completion bash"
        )
    return name


def script_of(shell: str) -> str:
    """Return click's completion script for a shell."""
    complete = SHELLS[shell](click.Command("navette"), {}, "navette", VARIABLE)
    return complete.source()


def install_script(shell: str, home: Path) -> list[Path]:
    """Write the script and, for bash and zsh, a line in the settings that loads it.

    A second call changes nothing. Returns the files that were written.
    """
    folder = home / ".config" / ("fish/completions" if shell == "fish" else "navette")
    script = folder / ("navette.fish" if shell == "fish" else f"completion.{shell}")
    folder.mkdir(parents=True, exist_ok=True)
    script.write_text(script_of(shell), encoding="utf-8")
    if shell not in _SETTINGS:
        return [script]
    settings = home / _SETTINGS[shell]
    line = f"source '{script}'"
    text = settings.read_text(encoding="utf-8") if settings.is_file() else ""
    if line in text.splitlines():
        return [script]
    gap = "" if not text or text.endswith("\n") else "\n"
    settings.write_text(f"{text}{gap}{line}\n", encoding="utf-8")
    return [script, settings]


def is_completing() -> bool:
    """Whether the shell started this process to get completions."""
    return VARIABLE in os.environ


def discard_stderr() -> None:
    """Discard messages: they would appear in the line that is being typed."""
    sys.stderr = Path(os.devnull).open("w")  # noqa: SIM115 - until the process ends
