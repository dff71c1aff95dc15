"""What is said beside the result, on standard error: remarks, and why a verb failed."""

import os
import shutil
import sys
import textwrap
from typing import Any

import typer

from navette.cli.escaping import escaped


def remark(text: str) -> None:
    """Tell a person something."""
    _say(text, dim=True)


def complain(text: str) -> None:
    """Say what went wrong."""
    _say(f"navette: {text}", fg="red")


def _say(text: str, **style: Any) -> None:
    text = escaped(text)
    if sys.stderr.isatty():
        text = "\n".join(map(_wrapped, text.split("\n")))
        if "NO_COLOR" not in os.environ:
            text = typer.style(text, **style)
    sys.stderr.write(f"{text}\n")
    sys.stderr.flush()


def _wrapped(line: str) -> str:
    """On a terminal lines end between two words; what is one word stays one."""
    width = shutil.get_terminal_size().columns
    if len(line) <= width:
        return line
    return textwrap.fill(
        line,
        width,
        subsequent_indent="  ",
        break_long_words=False,
        break_on_hyphens=False,
        replace_whitespace=False,
    )
