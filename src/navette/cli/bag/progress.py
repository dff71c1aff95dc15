"""Progress bar on standard error; nothing in a pipe."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress(
    text: str, total: float | None, *, as_bytes: bool = False
) -> Iterator[Callable[[float], None] | None]:
    """Yield a function that advances the bar; None without a terminal.

    Args:
        total: length of the bar; None if unknown.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        DownloadColumn,
        Progress,
        TaskProgressColumn,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = [TextColumn("{task.description}"), BarColumn(), TaskProgressColumn()]
    if as_bytes:
        columns.append(DownloadColumn())
    columns.append(TimeRemainingColumn())
    with Progress(
        *columns, console=Console(stderr=True), transient=True, refresh_per_second=8
    ) as bar:
        task = bar.add_task(text, total=total)
        yield lambda step: bar.advance(task, step)
