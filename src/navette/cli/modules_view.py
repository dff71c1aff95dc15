"""How modules and what they say look: for people on a terminal, and piped."""

import json
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from datetime import datetime
from typing import TYPE_CHECKING

from rich.console import Console
from rich.live import Live
from rich.spinner import Spinner
from rich.table import Table
from rich.text import Text

from navette.cli.output import aligned, is_terminal, show
from navette.supervisor.session import ProcessView
from navette.supervisor.specs import State

if TYPE_CHECKING:
    from navette.supervisor.log_book import LogLine
    from navette.supervisor.usage import Usage

_MARKS = {
    State.WAITING: ("·", "dim"),
    State.STARTING: ("◐", "cyan"),
    State.RUNNING: ("●", "green"),
    State.PAUSING: ("↻", "yellow"),
    State.STOPPING: ("◑", "cyan"),
    State.STOPPED: ("○", "dim"),
    State.ENDED: ("✓", "dim"),
    State.FAILED: ("✗", "bold red"),
}
_LABEL_STYLES = ("cyan", "green", "magenta", "yellow", "blue", "bright_cyan")
_LEVELS = {"FATAL": "bold red", "ERROR": "red", "WARN": "yellow", "DEBUG": "dim"}
# How ROS 2 programs log; time and name stand before the line already.
_ROS_LINE = re.compile(
    r"\[(?P<level>[A-Z]+)\] \[\d+\.\d+\] \[(?P<name>[^\]]*)\]: (?P<text>.*)"
)


def console() -> Console:
    """The terminal (or pipe) of standard output."""
    return Console(highlight=False, soft_wrap=True)


class Progress:
    """Processes on their way up or down: a live picture, or a line each when piped.

    Args:
        before: the state that is no news at first.
    """

    def __init__(self, before: State | None = None) -> None:
        self._before = before
        self._told: dict[str, State] = {}
        self._spinner = Spinner("dots", style="cyan")

    def show(self, steps: Iterable[list[ProcessView]]) -> list[ProcessView]:
        """Show every step; the last one is what it came to."""
        found: list[ProcessView] = []
        if not is_terminal():
            for found in steps:
                self._tell(found)
            return found
        with Live(console=console(), refresh_per_second=12) as live:
            for found in steps:
                live.update(self._picture(found))
        return found

    def _tell(self, found: Sequence[ProcessView]) -> None:
        for view in found:
            is_news = self._told.get(view.label, self._before) is not view.state
            if is_news and view.is_settled:
                show("  ".join(filter(None, [view.label, _state_text(view)])))
            self._told[view.label] = view.state

    def _picture(self, found: Sequence[ProcessView]) -> Table:
        grid = Table.grid(padding=(0, 2))
        for view in found:
            mark, style = _MARKS[view.state]
            moving = view.state in (State.STARTING, State.STOPPING)
            grid.add_row(
                self._spinner if moving else Text(mark, style=style),
                Text(view.label),
                Text(_state_text(view), style=style),
                Text(f"pid {view.pid}" if view.pid else "", style="dim"),
            )
        return grid


def _state_text(view: ProcessView) -> str:
    text = view.state.value
    trouble = view.is_in_trouble or view.state is State.WAITING
    return f"{text}: {view.reason}" if view.reason and trouble else text


def show_trouble(view: ProcessView, words: Sequence[str]) -> None:
    """What a process in trouble said last."""
    out = Console(stderr=True, highlight=False, soft_wrap=True)
    out.print(Text(f"{view.label}: {view.reason}", style="bold red"))
    for word in words:
        out.print(Text(f"  {word}"))


def show_addresses(words: Iterable[Sequence[str]]) -> None:
    """Where to look at what was started, if a process said so."""
    for line in (line for lines in words for line in lines if "http://" in line):
        console().print(Text(plain_message(line), style="bright_blue"))


# -- ps ------------------------------------------------------------------------------

_HEADS = ("MODULE", "PROCESS", "STATE", "PID", "SINCE", "CPU", "MEMORY", "RESTARTS")


def show_processes(found: Sequence[ProcessView], usage: "Mapping[int, Usage]") -> None:
    """The table of ``navette ps``."""
    rows = [_row(view, usage) for view in found]
    if not is_terminal():
        for line in aligned([(*_HEADS, "REASON"), *rows]):
            show(line)
        return
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for head in _HEADS:
        numbers = head in ("PID", "SINCE", "CPU", "MEMORY", "RESTARTS")
        table.add_column(head, justify="right" if numbers else "left", no_wrap=True)
    table.add_column("", overflow="fold")
    before = ""
    for view, row in zip(found, rows, strict=True):
        mark, style = _MARKS[view.state]
        module = "" if view.module == before else view.module
        before = view.module
        table.add_row(
            Text(module, style="bold"),
            row[1],
            Text(f"{mark} {row[2]}", style=style),
            *row[3:8],
            Text(row[8], style=style),
        )
    console().print(table)


def _row(view: ProcessView, usage: "Mapping[int, Usage]") -> tuple[str, ...]:
    used = usage.get(view.pid or 0)
    share = None if used is None else _share(view, used)
    return (
        view.module,
        view.name,
        view.state.value,
        str(view.pid or ""),
        duration(view.seconds),
        "" if share is None else f"{share * 100:.0f} %",
        "" if used is None else f"{used.memory_bytes / 1e6:.0f} MB",
        str(view.restarts or ""),
        view.reason if view.state is not State.RUNNING else "",
    )


def _share(view: ProcessView, used: "Usage") -> float:
    """Of a processor, over its whole run."""
    return used.cpu_s / max(view.seconds, 0.1)


def as_record(
    view: ProcessView, folder: str, usage: "Mapping[int, Usage]"
) -> dict[str, object]:
    """A process of ``navette ps --json``."""
    used = usage.get(view.pid or 0)
    return {
        **asdict(view),
        "state": view.state.value,
        "folder": folder,
        "cpu": None if used is None else round(_share(view, used), 4),
        "memory_bytes": None if used is None else used.memory_bytes,
    }


def duration(seconds: float) -> str:
    """``8 s``, ``3 min``, ``2 h``, ``4 d``."""
    for size, unit in ((86400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if seconds >= size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.0f} s"


# -- logs ----------------------------------------------------------------------------


class LogView:
    """Lines of the log, each with its time and the name of who wrote it."""

    def __init__(self, *, as_json: bool = False) -> None:
        self._as_json = as_json
        self._styles: dict[str, str] = {}
        self._width = 0
        self._console = console()

    def show(self, lines: Iterable["LogLine"]) -> None:
        """Print lines, at once."""
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
                sys.stdout.write(f"{stamp} {line.label}: {mark}{line.text}\n")
        sys.stdout.flush()

    def _styled(self, line: "LogLine") -> Text:
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
    """A line of ROS 2's log without what stands before the message."""
    found = _ROS_LINE.fullmatch(line)
    if found is None:
        return line
    level = found["level"]
    return found["text"] if level == "INFO" else f"{level}: {found['text']}"
