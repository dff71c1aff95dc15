"""Rich tables with columns that are never wrapped and harmless text."""

import shutil
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from navette.files.untrusted.escaping import escaped

_WIDTH = 1000
_LONGEST = 200


class SafeConsole(Console):
    """Escapes control characters of texts, such as names in a recording."""

    def print(self, *objects: Any, **options: Any) -> None:
        super().print(*map(_safe, objects), **options)


class SafeTable(Table):
    """Escapes control characters of cells, and cuts very long ones."""

    def add_row(self, *cells: Any, **options: Any) -> None:
        safe = [_cut(_safe(cell)) for cell in cells]
        for k, column in enumerate(self.columns[: len(safe)]):
            if not column.no_wrap:  # it may be cut, not wrapped
                safe[k] = Text(str(safe[k]), no_wrap=True, overflow="ellipsis")
        super().add_row(*safe, **options)


def _safe(found: Any) -> Any:
    if isinstance(found, str):
        return escaped(found)
    if isinstance(found, Text) and escaped(found.plain) != found.plain:
        return Text(escaped(found.plain).replace("\n", "\\n"), style=found.style)
    return found


def _cut(cell: Any) -> Any:
    plain = cell.plain if isinstance(cell, Text) else str(cell)
    if len(plain) <= _LONGEST:
        return cell
    style = cell.style if isinstance(cell, Text) else ""
    return Text(f"{plain[: _LONGEST - 1]}…", style=style)


def open_console() -> Console:
    """Return a console that does not break lines."""
    return SafeConsole(highlight=False, soft_wrap=True, width=_WIDTH)


def new_table(*names: str) -> Table:
    """Return a table without borders.

    A leading ``>`` aligns a column to the right; one with a leading ``~`` is cut first
    where the terminal is narrow.
    """
    table = SafeTable(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for name in names:
        table.add_column(
            name.lstrip(">~"),
            justify="right" if name.startswith(">") else "left",
            header_style="dim",
            no_wrap=not name.startswith("~"),
        )
    return table


def show_table(console: Console, table: Table) -> None:
    """Print the table without trailing spaces; rows are cut to a terminal's width."""
    width = shutil.get_terminal_size().columns if console.is_terminal else _WIDTH
    with console.capture() as capture:
        console.print(table, width=width)
    for row in capture.get().splitlines():
        line = Text.from_ansi(row)
        line.rstrip()
        if console.is_terminal:
            line.truncate(width, overflow="ellipsis")
        console.print(line)


__all__ = ["Table", "new_table", "open_console", "show_table"]
