"""Display of services and their output, on a terminal and in a pipe."""

import json
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from datetime import datetime

from rich.console import Console
from rich.live import Live
from rich.spinner import Spinner
from rich.table import Table
from rich.text import Text

from navette.cli.output import aligned, is_terminal, show
from navette.files.untrusted.escaping import escaped_but_coloured
from navette.supervisor.log_store import LogLine
from navette.supervisor.service_config import ProcessState
from navette.supervisor.status import ProcessStatus
from navette.supervisor.usage import Usage

_MARKS = {
    ProcessState.WAITING: ("·", "dim"),
    ProcessState.STARTING: ("◐", "cyan"),
    ProcessState.RUNNING: ("●", "green"),
    ProcessState.RESTARTING: ("↻", "yellow"),
    ProcessState.STOPPING: ("◑", "cyan"),
    ProcessState.STOPPED: ("○", "dim"),
    ProcessState.ENDED: ("✓", "dim"),
    ProcessState.FAILED: ("✗", "bold red"),
}
_LABEL_STYLES = ("cyan", "green", "magenta", "yellow", "blue", "bright_cyan")
_LEVELS = {"FATAL": "bold red", "ERROR": "red", "WARN": "yellow", "DEBUG": "dim"}
# Format of ROS 2 programs; time and name are shown in columns of their own.
_ROS_LINE = re.compile(
    r"\[(?P<level>[A-Z]+)\] \[\d+\.\d+\] \[(?P<name>[^\]]*)\]: (?P<text>.*)"
)


def console() -> Console:
    """Return a console for the standard output."""
    return Console(highlight=False, soft_wrap=True)


class Progress:
    """Progress of starting or stopping processes.

    A live table on a terminal; in a pipe, a line for each change.

    Args:
        before: initial state, which is not printed in a pipe.
    """

    def __init__(self, before: ProcessState | None = None) -> None:
        self._before = before
        self._shown: dict[str, ProcessState] = {}
        self._spinner = Spinner("dots", style="cyan")

    def show(self, steps: Iterable[list[ProcessStatus]]) -> list[ProcessStatus]:
        """Show every step; return the last one."""
        found: list[ProcessStatus] = []
        if not is_terminal():
            for found in steps:
                self._print_changes(found)
            return found
        with Live(console=console(), refresh_per_second=12) as live:
            for found in steps:
                live.update(self._table(found))
        return found

    def _print_changes(self, found: Sequence[ProcessStatus]) -> None:
        for process in found:
            has_changed = (
                self._shown.get(process.label, self._before) is not process.state
            )
            if has_changed and process.is_settled:
                show("  ".join(filter(None, [process.label, _state_text(process)])))
            self._shown[process.label] = process.state

    def _table(self, found: Sequence[ProcessStatus]) -> Table:
        grid = Table.grid(padding=(0, 2))
        for process in found:
            mark, style = _MARKS[process.state]
            is_moving = process.state in (ProcessState.STARTING, ProcessState.STOPPING)
            grid.add_row(
                self._spinner if is_moving else Text(mark, style=style),
                Text(process.label),
                Text(_state_text(process), style=style),
                Text(f"pid {process.pid}" if process.pid else "", style="dim"),
            )
        return grid


def _state_text(process: ProcessStatus) -> str:
    text = process.state.value
    trouble = process.is_in_trouble or process.state is ProcessState.WAITING
    return f"{text}: {process.reason}" if process.reason and trouble else text


def show_failure(process: ProcessStatus, lines: Sequence[str]) -> None:
    """Print why a process failed, and its last output."""
    out = Console(stderr=True, highlight=False, soft_wrap=True)
    out.print(Text(f"{process.label}: {process.reason}", style="bold red"))
    for line in lines:
        out.print(Text(f"  {line}"))


def show_addresses(outputs: Iterable[Sequence[str]]) -> None:
    """Print the lines of output that contain a web address."""
    for line in (line for lines in outputs for line in lines if "http://" in line):
        console().print(Text(plain_message(line), style="bright_blue"))


_HEADS = ("SERVICE", "PROCESS", "STATE", "PID", "TIME", "CPU", "MEMORY", "RESTARTS")


def show_processes(found: Sequence[ProcessStatus], usage: Mapping[int, Usage]) -> None:
    """Print the table of ``navette ps``."""
    rows = [_row(process, usage) for process in found]
    if not is_terminal():
        for line in aligned([(*_HEADS, "REASON"), *rows]):
            show(line)
        return
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for head in _HEADS:
        numbers = head in ("PID", "TIME", "CPU", "MEMORY", "RESTARTS")
        table.add_column(head, justify="right" if numbers else "left", no_wrap=True)
    table.add_column("", overflow="fold")
    before = ""
    for process, row in zip(found, rows, strict=True):
        mark, style = _MARKS[process.state]
        service = "" if process.service == before else process.service
        before = process.service
        table.add_row(
            Text(service, style="bold"),
            row[1],
            Text(f"{mark} {row[2]}", style=style),
            *row[3:8],
            Text(row[8], style=style),
        )
    console().print(table)


def _row(process: ProcessStatus, usage: Mapping[int, Usage]) -> tuple[str, ...]:
    used = usage.get(process.pid or 0)
    share = None if used is None else _share(process, used)
    return (
        process.service,
        process.name,
        process.state.value,
        str(process.pid or ""),
        duration(process.seconds),
        "" if share is None else f"{share * 100:.0f} %",
        "" if used is None else f"{used.memory_bytes / 1e6:.0f} MB",
        str(process.restarts or ""),
        process.reason if process.state is not ProcessState.RUNNING else "",
    )


def _share(process: ProcessStatus, used: Usage) -> float:
    """Return the share of one processor over the whole run."""
    return used.cpu_s / max(process.seconds, 0.1)


def as_record(
    process: ProcessStatus, folder: str, usage: Mapping[int, Usage]
) -> dict[str, object]:
    """Return a process as ``navette ps --json`` prints it."""
    used = usage.get(process.pid or 0)
    return {
        **asdict(process),
        "state": process.state.value,
        "folder": folder,
        "cpu": None if used is None else round(_share(process, used), 4),
        "memory_bytes": None if used is None else used.memory_bytes,
    }


def duration(seconds: float) -> str:
    """Format a duration as ``8 s``, ``3 min``, ``2 h`` or ``4 d``."""
    for size, unit in ((86400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if seconds >= size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} s"


class LogView:
    """Prints lines of the log with their time and process."""

    def __init__(self, *, as_json: bool = False) -> None:
        self._as_json = as_json
        self._styles: dict[str, str] = {}
        self._width = 0
        self._console = console()

    def show(self, lines: Iterable[LogLine]) -> None:
        lines = list(lines)
        self._width = max([self._width, *(len(line.label) for line in lines)])
        for line in lines:
            if self._as_json:
                sys.stdout.write(json.dumps(asdict(line)) + "\n")
            elif is_terminal():
                self._console.print(self._styled(line))
            else:
                stamp = datetime.fromtimestamp(line.t / 1e9).isoformat(
                    timespec="milliseconds"
                )
                mark = "* " if line.event else ""
                sys.stdout.write(
                    f"{stamp} {line.label}: {mark}{escaped_but_coloured(line.text)}\n"
                )
        sys.stdout.flush()

    def _styled(self, line: LogLine) -> Text:
        label = line.label
        style = self._styles.setdefault(
            label, _LABEL_STYLES[len(self._styles) % len(_LABEL_STYLES)]
        )
        stamp = datetime.fromtimestamp(line.t / 1e9).strftime("%H:%M:%S")
        text = Text(f"{stamp} ", style="dim")
        text.append(f"{label:<{self._width}} ", style=style)
        text.append("│ ", style="dim")
        if line.event:
            text.append(line.text, style="dim italic")
        else:
            level = _ROS_LINE.match(line.text)
            style = _LEVELS.get(level["level"], "") if level else ""
            text.append(Text.from_ansi(plain_message(line.text), style=style))
        return text


def plain_message(line: str) -> str:
    """Return the message of a line in ROS 2's log format."""
    found = _ROS_LINE.fullmatch(line)
    if found is None:
        return line
    level = found["level"]
    return found["text"] if level == "INFO" else f"{level}: {found['text']}"
