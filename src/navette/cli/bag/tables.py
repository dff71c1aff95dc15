"""Tables whose columns are as wide as they must be: names are never folded."""

from rich.console import Console
from rich.table import Table

_WIDTH = 1000


def open_console() -> Console:
    """Prints lines as they are; a terminal too narrow wraps them."""
    return Console(highlight=False, soft_wrap=True, width=_WIDTH)


def new_table(*names: str) -> Table:
    """A table without lines; names that begin with ``>`` are of right columns."""
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
    """Print it without blanks at the ends of lines."""
    with console.capture() as capture:
        console.print(table)
    for line in capture.get().splitlines():
        console.out(line.rstrip(), highlight=False)


__all__ = ["Table", "new_table", "open_console", "show_table"]
