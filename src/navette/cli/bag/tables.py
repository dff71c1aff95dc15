"""Rich tables whose columns are never wrapped."""

from rich.console import Console
from rich.table import Table

_WIDTH = 1000


def open_console() -> Console:
    """Return a console that does not break lines."""
    return Console(highlight=False, soft_wrap=True, width=_WIDTH)


def new_table(*names: str) -> Table:
    """Return a table without borders; a leading ``>`` aligns a column to the right."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for name in names:
        table.add_column(
            name.removeprefix(">"),
            justify="right" if name.startswith(">") else "left",
            header_style="dim",
            no_wrap=True,
        )
    return table


def show_table(console: Console, table: Table) -> None:
    """Print the table without trailing spaces."""
    with console.capture() as capture:
        console.print(table)
    for line in capture.get().splitlines():
        console.out(line.rstrip(), highlight=False)


__all__ = ["Table", "new_table", "open_console", "show_table"]
