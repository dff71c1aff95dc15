"""What verbs print: styled for people on a terminal, plain where it is piped."""

import json
import os
import sys
from collections.abc import Iterable, Sequence
from typing import Any

import typer


def is_terminal() -> bool:
    """Whether a person reads standard output."""
    return sys.stdout.isatty()


def styled(text: str, **style: Any) -> str:
    """``text`` in colours (``typer.style``'s arguments) where a person reads it."""
    if not is_terminal() or "NO_COLOR" in os.environ:
        return text
    return typer.style(text, **style)


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
