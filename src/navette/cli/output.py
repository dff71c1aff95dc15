"""What verbs print: styled for people on a terminal, plain where it is piped."""

import json
import os
import re
import shutil
import sys
import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

import typer

_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")


def is_terminal() -> bool:
    """Whether a person reads standard output."""
    return sys.stdout.isatty()


def styled(text: str, **style: Any) -> str:
    """``text`` in colours (``typer.style``'s arguments) where a person reads it."""
    if not is_terminal() or "NO_COLOR" in os.environ:
        return text
    return typer.style(text, **style)


def cut_to_width(line: str) -> str:
    """A line that a person reads, cut to one line of the terminal."""
    width = shutil.get_terminal_size().columns
    if not is_terminal() or len(line) <= width:
        return line
    return f"{line[: width - 1]}…"


def wrapped(text: str, indent: int) -> list[str]:
    """Lines that a person's terminal has room for beside an indent; one in a pipe."""
    if not is_terminal():
        return [text] if text else []
    width = shutil.get_terminal_size().columns - indent
    return textwrap.wrap(
        text, max(width, 20), break_long_words=False, break_on_hyphens=False
    )


def harmless(text: str) -> str:
    """On a terminal, control characters in what others sent must not act."""
    if not is_terminal():
        return text
    return _CONTROL.sub(lambda match: f"\\x{ord(match[0]):02x}", text)


def note(text: str) -> None:
    """Tell a person something beside the result: to standard error."""
    dim = sys.stderr.isatty() and "NO_COLOR" not in os.environ
    sys.stderr.write((typer.style(text, dim=True) if dim else text) + "\n")
    sys.stderr.flush()


def show(text: str = "") -> None:
    """Print a line or several, at once also into a pipe."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def show_json(value: Any) -> None:
    """Print a value as JSON, for programs: indented only for a person."""
    show(json.dumps(value, indent=2 if is_terminal() else None, ensure_ascii=False))


def aligned(rows: Iterable[Sequence[str]], *, gap: int = 2) -> list[str]:
    """Rows of words as lines whose columns stand under each other."""
    table = [list(row) for row in rows]
    widths: list[int] = []
    for row in table:
        for column, word in enumerate(row):
            if column == len(widths):
                widths.append(0)
            widths[column] = max(widths[column], len(word))
    return [
        (" " * gap)
        .join(word.ljust(width) for word, width in zip(row, widths, strict=False))
        .rstrip()
        for row in table
    ]
