"""Progress of a simulation run on stderr; stdout is left for data."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.console import Console, RenderableType
from rich.live import Live
from rich.status import Status
from rich.table import Table
from rich.text import Text

from navette.cli.hanging_indent import print_beside
from navette.msgs.topics import CMD_VEL_NAV
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.summary import PoseError, RunSummary
from navette.runtime import Stopwatch
from navette.runtime.stage.commander import Commander
from navette.runtime.stage.status import spelled

if TYPE_CHECKING:
    from navette.navigation.stack.monitor import RunProgress
    from navette.navigation.stack.simulation import Simulation

_REFRESH_HZ = 8
_LINES_S = 2.0  # between lines of progress that are not on a terminal
_WIDTH = 24
_BESIDE_BAR = 60  # columns that the figures beside the bar may take
_LONG_M = 1e6  # coordinates from here on are shown with an exponent
_EXACT_M = 0.005  # a smaller error of the pose is not shown
_NOT_FINITE = "goal_not_finite"
_CANCELED = "canceled"
_FOLLOWING = "following"


class StatusScreen:
    """Lines for past events and, on a terminal, one live line of progress."""

    def __init__(self, options: RunOptions) -> None:
        self._options = options
        self._console = Console(stderr=True, highlight=False)
        self._longest_m: dict[str, float] = {}
        self._reported: list[str] = []
        self._commander = Commander()
        self._starting: Status | None = None
        self._line_due = Stopwatch()

    @contextmanager
    def starting(self) -> Iterator[None]:
        """Show that nodes are created."""
        with self._console.status("starting", spinner="dots") as self._starting:
            yield
        self._starting = None

    def show_line(self, text: str) -> None:
        """Print what is being done before the run."""
        print_beside(self._console, Text(), Text(text))

    def show_progress(self, text: str) -> None:
        """Show how far that is: beside the spinner, or in lines every few seconds."""
        if self._console.is_terminal:
            if self._starting is not None:
                self._starting.update(text)
        elif self._line_due.elapsed_s >= _LINES_S:
            self._line_due = Stopwatch()
            self.show_line(text)

    @contextmanager
    def watching(self, simulation: "Simulation") -> Iterator[None]:
        """Show the progress until the block ends."""
        self._show_head(simulation)
        if not self._console.is_terminal:
            yield
            return
        with Live(
            get_renderable=lambda: self._line(simulation),
            console=self._console,
            refresh_per_second=_REFRESH_HZ,
            transient=True,
        ):
            yield

    def on_change(self, progress: "RunProgress") -> None:
        """Print a line when a goal starts, ends or fails, and on a takeover."""
        self._print(progress, self._takeover(progress))
        text = self._event(progress)
        if text is not None and self._reported[-1:] != [text.plain]:
            self._reported.append(text.plain)
            self._print(progress, text)

    def report(self, summary: RunSummary, *, interrupted: bool) -> None:
        """Print the goals still without an end, then the summary of the run."""
        if not interrupted:
            self._report_open_goals(summary)
        reached = sum(goal.result == "reached" for goal in summary.goals)
        clearance = summary.min_clearance_m
        parts = [
            f"{reached} of {len(self._options.goals)} goals reached"
            if self._options.goals
            else "no goals",
            _missed(summary),
            f"{summary.contacts} contact{'' if summary.contacts == 1 else 's'}",
            f"minimum clearance {clearance:.2f} m" if clearance is not None else "",
            _pose_error(summary.pose_error_m),
            f"{summary.sim_time_s:.1f} s simulated in {summary.wall_time_s:.1f} s "
            f"(×{summary.real_time_factor:.1f})",
        ]
        word = "interrupted" if interrupted else "done"
        good = summary.contacts == 0 and reached == len(self._options.goals)
        good &= summary.missed_m is None
        print_beside(
            self._console,
            Text(f"{word}: ", "bold green" if good else "bold yellow"),
            Text(", ".join(part for part in parts if part)),
        )

    def _report_open_goals(self, summary: RunSummary) -> None:
        """Print goals whose end is not shown yet: mostly unfinished ones."""
        for goal in summary.goals:
            if goal.result == "reached":
                continue
            line = f"✗ goal {_point(goal.goal)} {spelled(goal.result)}"
            if line in self._reported:
                continue
            left = goal.distance_left_m
            if math.isfinite(left):
                line += f", {left:.1f} m left"
            stamp = Text(f"{summary.sim_time_s:8.1f} s  ", style="dim")
            print_beside(self._console, stamp, Text(line, style="yellow"))

    def report_failure(self, text: str) -> None:
        print_beside(self._console, Text(), Text(text, style="bold red"))

    def _show_head(self, simulation: "Simulation") -> None:
        options = self._options
        head = Text.assemble(
            ("Navette", "bold cyan"),
            (f"  {options.world}", "bold"),
            f" · {simulation.resolved.robot_name} · seed {options.seed}",
        )
        self._console.print(head, soft_wrap=True)
        if simulation.viewer is not None:
            self._console.print(
                Text.assemble(
                    ("live view  ", "dim"),
                    (simulation.viewer.url, "underline bright_blue"),
                    ("   Ctrl-C ends", "dim"),
                ),
                soft_wrap=True,
            )
            more = "more goals" if options.goals else "goals"
            self._console.print(
                Text(f"{more}      click in the map of the live view", style="dim"),
                soft_wrap=True,
            )
            if simulation.viewer.remote_url:
                remote = Text(simulation.viewer.remote_url, style="underline")
                head = Text("elsewhere  ", style="dim") + remote
                self._console.print(head, soft_wrap=True)

    def _print(self, progress: "RunProgress", text: Text | None) -> None:
        if text is not None:
            stamp = Text(f"{progress.sim_time_s:8.1f} s  ", style="dim")
            print_beside(self._console, stamp, text)

    def _takeover(self, progress: "RunProgress") -> Text | None:
        """Return a line when another source than navigation begins or ends."""
        before, commander = self._commander, progress.commander
        self._commander = commander
        if commander.name == before.name:
            return None
        if commander.is_stopped:
            return Text("■ emergency stop; navette stop --release", style="bold red")
        if commander.masks(CMD_VEL_NAV.name):
            return Text(f"‖ {commander.text} commands", style="yellow")
        if before.masks(CMD_VEL_NAV.name):
            return Text("▸ navigation may drive again", style="cyan")
        return None

    def _event(self, progress: "RunProgress") -> Text | None:
        if progress.goal is None:
            refused = progress.state == _NOT_FINITE  # such a goal has no place
            return Text(f"✗ {progress.state}", style="red") if refused else None
        where = f"goal {_point(progress.goal)}"
        if progress.state == "reached":
            return Text(f"✓ {where} reached", style="green")
        if progress.failed:
            return Text(f"✗ {where} {progress.state}", style="red")
        if progress.state == _CANCELED:
            return Text(f"✗ {where} {spelled(progress.state)}", style="yellow")
        if progress.goal_id not in self._longest_m:
            self._longest_m[progress.goal_id] = 0.0
            again = f", retry {progress.retry}" if progress.retry else ""
            return Text(f"→ {where}{again}")
        return None

    def _line(self, simulation: "Simulation") -> RenderableType:
        progress = simulation.progress()
        line = Table.grid(padding=(0, 2))
        for _ in range(5):
            line.add_column(no_wrap=True)  # a narrow terminal shortens, one line stays
        line.add_row(
            Text(f"{progress.sim_time_s:8.1f} s", style="dim"),
            self._bar(progress),
            Text(_left(progress)),
            Text(_activity(progress), style="cyan"),
            Text(f"×{simulation.real_time_factor():.2f}", style="dim"),
        )
        return line

    def _bar(self, progress: "RunProgress") -> Text:
        left = progress.distance_left_m
        width = max(0, min(_WIDTH, self._console.width - _BESIDE_BAR))
        if left is None or not _is_driven_to(progress):
            return Text("─" * width, style="dim")
        longest = max(self._longest_m.get(progress.goal_id, 0.0), left, 1e-6)
        self._longest_m[progress.goal_id] = longest
        done = round(width * (1 - left / longest))
        return Text.assemble(("━" * done, "green"), ("─" * (width - done), "dim"))


def _missed(summary: RunSummary) -> str:
    """Return the true distance from a goal that only the estimate reached."""
    if summary.missed_m is None:
        return ""
    tolerance_m = summary.goal_tolerance_m
    missed = f"{summary.missed_m:.2f}"
    if float(missed) <= tolerance_m:
        missed = f"{summary.missed_m:.4f}"
    return (
        f"by the estimate only (truly up to {missed} m away, "
        f"tolerance {tolerance_m:g} m)"
    )


def _pose_error(error: PoseError) -> str:
    """Return the error of the estimated pose; empty if it is the true one."""
    if error.map_fits_world is False:
        return "pose error unknown (the map is not in the world's frame)"
    if error.final is None:
        return "pose unknown"
    if error.worst is not None and error.worst < _EXACT_M:
        return ""
    worst = "never localized" if error.worst is None else f"worst {error.worst:.2f} m"
    return f"pose error {error.final:.2f} m ({worst})"


def _has_goal(progress: "RunProgress") -> bool:
    """Whether there is a goal that was not cancelled."""
    return progress.goal is not None and progress.state != _CANCELED


def _is_driven_to(progress: "RunProgress") -> bool:
    """Whether the goal neither failed nor was cancelled."""
    return _has_goal(progress) and not progress.failed


def _activity(progress: "RunProgress") -> str:
    """Return what the planner does or how the goal ended; while it drives, control."""
    if _has_goal(progress) and progress.state != _FOLLOWING:
        return progress.state
    return progress.control or progress.state


def _left(progress: "RunProgress") -> str:
    if progress.goal is None or progress.state == _CANCELED:
        return "waiting for a goal"
    to = f"to {_point(progress.goal)}"
    if progress.distance_left_m is None or not _is_driven_to(progress):
        return to
    return f"{progress.distance_left_m:5.1f} m {to}"


def _point(goal: tuple[float, float]) -> str:
    x, y = (f"{v:.1f}" if abs(v) < _LONG_M else f"{v:g}" for v in goal)
    return f"({x}, {y})"
