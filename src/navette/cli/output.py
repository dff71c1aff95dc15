"""Output of verbs: styled on a terminal, plain in a pipe."""

import json
import math
import shutil
import sys
import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import click

from navette.cli.colours import colours_wanted
from navette.cli.stderr import filled
from navette.files.untrusted.escaping import escaped, escaped_but_coloured, escaped_json

# Overwriting line by line does not flicker, unlike clearing the screen first.
_CLEAR, _HOME, _END_OF_LINE, _BELOW = "\x1b[2J", "\x1b[H", "\x1b[K", "\x1b[J"


def is_terminal() -> bool:
    """Whether standard output is a terminal."""
    return sys.stdout.isatty()


def styled(text: str, **style: Any) -> str:
    """Style a text with the arguments of ``click.style``, on a terminal only."""
    if not is_terminal() or not colours_wanted():
        return text
    return click.style(text, **style)


def cut_to_width(line: str) -> str:
    """Cut a line to the width of the terminal; unchanged in a pipe."""
    width = shutil.get_terminal_size().columns
    if not is_terminal() or len(line) <= width:
        return line
    return f"{line[: width - 1]}…"


def wrapped(text: str, indent: int) -> list[str]:
    """Wrap a text to the terminal's width minus an indent; one line in a pipe."""
    if not is_terminal():
        return [text] if text else []
    width = shutil.get_terminal_size().columns - indent
    return textwrap.wrap(
        text, max(width, 20), break_long_words=False, break_on_hyphens=False
    )


def hanging(lines: str, indent: int) -> str:
    """Wrap each line at spaces, with an indent; unchanged in a pipe."""
    if not is_terminal():
        return lines
    return "\n".join(filled(line, indent) for line in lines.split("\n"))


def harmless(text: str) -> str:
    """Escape control characters of received text, on a terminal only."""
    return escaped(text) if is_terminal() else text


def show(text: str = "") -> None:
    """Print lines and flush them; on a terminal, only colours act on it."""
    _write(_harmless_but_coloured(text))


def show_over(text: str, *, rows: int | None = None, clear: bool = False) -> None:
    """Print lines over earlier ones on a terminal; below them in a pipe.

    Only this function moves the cursor. The text is escaped as in :func:`show`.

    Args:
        rows: how many rows above the cursor to overwrite; None: the whole screen.
        clear: clear the screen first.
    """
    if not is_terminal():
        show(text)
        return
    start = _HOME if rows is None else f"\x1b[{rows}F" if rows else ""
    lines = _harmless_but_coloured(text).replace("\n", f"{_END_OF_LINE}\n")
    _write(f"{_CLEAR if clear else ''}{start}{lines}{_END_OF_LINE}{_BELOW}")


def _harmless_but_coloured(text: str) -> str:
    harmless_text = escaped_but_coloured(text)
    return harmless_text if harmless_text != text and is_terminal() else text


def _write(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def show_json(value: Any) -> None:
    """Print a value as JSON, indented on a terminal."""
    show(json_text(value, indent=2 if is_terminal() else None))


def show_names(names: Sequence[str], *, count: bool, as_json: bool) -> None:
    """Print names one per line, as JSON, or only their number."""
    if count:
        show(str(len(names)))
    elif as_json:
        show_json(list(names))
    elif names:
        show("\n".join(map(escaped, names)))


def json_text(value: Any, *, indent: int | None = None) -> str:
    """Return standard JSON: null for NaN and infinity, control characters escaped."""
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
    """Format names with a second column; below the name if the terminal is narrow.

    Args:
        fades: whether a name is printed dim.
    """
    rows = [(escaped(name), escaped(text)) for name, text in pairs]
    width = max((len(name) for name, _ in rows), default=0)
    room = shutil.get_terminal_size().columns - indent - width - 2
    lines = []
    for name, text in rows:
        shown = styled(name, dim=True if fades(name) else None)
        gap = " " * (width - len(name) + 2)
        if len(text) > room:
            gap = f"\n{' ' * (indent + 4)}"
        second = f"{gap}{styled(text, dim=True)}" if text else ""
        lines.append(f"{' ' * indent}{shown}{second}")
    return lines


def aligned(rows: Iterable[Sequence[str]], *, gap: int = 2) -> list[str]:
    """Format rows of words as lines with aligned columns."""
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
