"""Notes and error messages on standard error."""

import shutil
import sys
from typing import Any

import click

from navette.cli.colours import colours_wanted
from navette.files import terminal_lines
from navette.files.untrusted.escaping import escaped


def note(text: str) -> None:
    """Print a note to the user."""
    _print(text, dim=True)


def print_error(text: str) -> None:
    """Print an error message."""
    _print(f"navette: {text}", fg="red")


def _print(text: str, **style: Any) -> None:
    text = escaped(text)
    if sys.stderr.isatty():
        text = "\n".join(map(filled, text.split("\n")))
        if colours_wanted():
            text = click.style(text, **style)
    sys.stderr.write(f"{text}\n")
    sys.stderr.flush()


def filled(line: str, indent: int = 2) -> str:
    """Wrap a line at spaces to the terminal's width."""
    return terminal_lines.filled(line, shutil.get_terminal_size().columns, indent)
