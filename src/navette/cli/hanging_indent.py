"""Lines that fit the terminal: wrapped beside their head, or between their parts."""

from collections.abc import Iterable

from rich.console import Console
from rich.table import Table
from rich.text import Text


def print_beside(console: Console, head: Text, text: Text) -> None:
    """Print a text after a head; on a terminal, further lines start below the text.

    In a pipe, the text is one line of any length.
    """
    if not head or not console.is_terminal:
        console.print(head + text, soft_wrap=not console.is_terminal)
        return
    line = Table.grid()
    line.add_column(no_wrap=True)
    line.add_column()
    line.add_row(head, text)
    console.print(line)


def in_rows(parts: Iterable[Text], width: int, *, gap: int = 3) -> Text:
    """Join parts with a gap, in as many lines as they need at a width."""
    rows: list[Text] = []
    for part in parts:
        if rows and rows[-1].cell_len + gap + part.cell_len <= width:
            rows[-1].append(" " * gap).append_text(part)
        else:
            rows.append(part.copy())
    return Text("\n").join(rows)
