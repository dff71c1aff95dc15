"""Lists of the private runs of this user."""

from collections.abc import Sequence
from dataclasses import asdict

from navette.cli.output import aligned, is_terminal, show
from navette.files.runs import RunInfo

_HEADS = ("RUN", "COMMAND", "WORLD", "PAGE", "PID")


def show_runs(runs: Sequence[RunInfo]) -> None:
    """Print a table of runs."""
    rows = [run.row() for run in runs]
    if not is_terminal():
        for line in aligned([_HEADS, *rows]):
            show(line)
        return
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for head in _HEADS:
        table.add_column(head, justify="right" if head == "PID" else "left")
    for name, command, world, page, pid in rows:
        table.add_row(
            Text(name, style="bold"),
            command,
            world,
            Text(page, style="bright_blue"),
            pid,
        )
    Console(highlight=False, soft_wrap=True).print(table)


def run_record(run: RunInfo) -> dict[str, object]:
    """Return a run as JSON value."""
    record = {"run": run.name, **asdict(run)}
    del record["name"], record["folder"], record["start_ns"]
    return record
