"""What verbs print: styled for people on a terminal, plain where it is piped."""

import json
import math
import os
import shutil
import sys
import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import typer

from navette.cli.escaping import escaped, escaped_json
from navette.cli.remarks import remark
from navette.cli.session import fail


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
    return escaped(text)


def note(text: str) -> None:
    """Tell a person something beside the result: to standard error."""
    remark(text)


def show(text: str = "") -> None:
    """Print a line or several, at once also into a pipe.

    Ends the command where they cannot be written (but as a broken pipe does it).
    """
    try:
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        sys.stdout = Path(os.devnull).open("w")  # noqa: SIM115 - what is left goes there
        fail(f"standard output cannot be written: {error.strerror}")


def show_json(value: Any) -> None:
    """Print a value as JSON, for programs: indented only for a person."""
    show(json_text(value, indent=2 if is_terminal() else None))


def json_text(value: Any, *, indent: int | None = None) -> str:
    """JSON as every parser reads it: null for numbers that JSON has not (NaN, ∞).

    Control characters are escaped: a terminal does not see them.
    """
    try:
        text = json.dumps(value, indent=indent, ensure_ascii=False, allow_nan=False)
    except ValueError:
        text = json.dumps(_finite(value), indent=indent, ensure_ascii=False)
    return escaped_json(text)


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {name: _finite(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(each) for each in value]
    return value


def beside(
    pairs: Iterable[tuple[str, str]],
    *,
    indent: int = 0,
    fades: Callable[[str], bool] = lambda name: False,
) -> list[str]:
    """Names, and what is to say of each in a column beside them, for a person.

    Below the name where the terminal is too narrow. ``fades``: whether a name stays
    in the background.
    """
    rows = list(pairs)
    width = max((len(name) for name, _ in rows), default=0)
    room = shutil.get_terminal_size().columns - indent - width - 2
    lines = []
    for name, text in rows:
        shown = styled(name, dim=True if fades(name) else None)
        gap = " " * (width - len(name) + 2)
        if len(text) > room:
            gap = f"\n{' ' * (indent + 4)}"
        said = f"{gap}{styled(text, dim=True)}" if text else ""
        lines.append(f"{' ' * indent}{shown}{said}")
    return lines


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
