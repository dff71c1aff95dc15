"""The live line on terminals of several widths."""

import io
import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from rich.console import Console
from rich.text import Text

from navette.cli.hanging_indent import in_rows, print_beside
from navette.cli.status import StatusScreen
from navette.navigation.missions.sequence import GoalOutcome
from navette.navigation.stack import RunOptions
from navette.navigation.stack.monitor import RunProgress
from navette.navigation.stack.summary import PoseError, RunSummary
from navette.runtime.stage.commander import Commander


@pytest.mark.parametrize("columns", [30, 60, 80, 200])
def test_the_live_line_stays_one_line(columns: int) -> None:
    screen = StatusScreen(RunOptions(goals=((-12.5, 3.0),)))
    shown = io.StringIO()
    screen._console = Console(file=shown, width=columns, force_terminal=False)
    progress = RunProgress(
        goal=(-12.5, 3.0),
        goal_id="1",
        state="following",
        control="following",
        distance_left_m=12.9,
        sim_time_s=1234.5,
    )
    run = SimpleNamespace(progress=lambda: progress, real_time_factor=lambda: 61.25)
    screen._console.print(screen._line(run))
    lines = shown.getvalue().splitlines()
    assert len(lines) == 1
    assert len(lines[0]) <= columns
    if columns >= 80:
        assert "1234.5 s" in lines[0]
        assert "12.9 m to (-12.5, 3.0)" in lines[0]
        assert "following" in lines[0]


def test_takeovers_are_printed_once() -> None:
    screen = StatusScreen(RunOptions())
    shown = io.StringIO()
    screen._console = Console(file=shown, width=80, force_terminal=False)
    masked = frozenset({"/cmd_vel_nav"})
    for commander in (
        Commander("navigation"),
        Commander("operator", masked, ("/teleop",)),
        Commander("operator", masked, ("/teleop",)),
        Commander("emergency_stop", masked),
        Commander("idle"),
        Commander("navigation"),
    ):
        screen.on_change(RunProgress(commander=commander, sim_time_s=2.0))
    lines = [line.split("s  ", 1)[1] for line in shown.getvalue().splitlines()]
    assert lines == [
        "‖ operator (teleop) commands",
        "■ emergency stop; navette stop --release",
        "▸ navigation may drive again",
    ]


def test_a_cancelled_goal_and_one_far_away_are_a_line_each() -> None:
    screen = StatusScreen(RunOptions())
    shown = io.StringIO()
    screen._console = Console(file=shown, width=80, force_terminal=False)
    driven = RunProgress(goal=(1.0, 2.0), goal_id="1", state="ok", distance_left_m=9.0)
    canceled = replace(driven, state="canceled")
    for progress in (
        driven,
        canceled,
        RunProgress(
            goal=(1e308, -3.0), goal_id="2", state="goal_outside_map", failed=True
        ),
        RunProgress(goal=None, goal_id="3", state="goal_not_finite", failed=True),
    ):
        screen.on_change(progress)
    lines = [line.split("s  ", 1)[1] for line in shown.getvalue().splitlines()]
    assert lines == [
        "→ goal (1.0, 2.0)",
        "✗ goal (1.0, 2.0) cancelled",
        "✗ goal (1e+308, -3.0) goal_outside_map",
        "✗ goal_not_finite",
    ]
    run = SimpleNamespace(progress=lambda: canceled, real_time_factor=lambda: 1.0)
    screen._console.print(screen._line(run))
    assert "waiting for a goal" in shown.getvalue()


def test_goals_without_an_end_are_named_before_the_summary() -> None:
    goals = ((1.0, 2.0), (3.0, 4.0), (5.0, 6.0))
    screen = StatusScreen(RunOptions(goals=goals))
    shown = io.StringIO()
    screen._console = Console(file=shown, width=80, force_terminal=False)
    screen.on_change(
        RunProgress(goal=(1.0, 2.0), goal_id="1", state="no_path", failed=True)
    )
    outcomes = (
        GoalOutcome((1.0, 2.0), "no_path", 3.0, 0.0, 2.0),
        GoalOutcome((3.0, 4.0), "timed_out", 300.0, 170.0, 109.98),
        GoalOutcome((5.0, 6.0), "unfinished", 0.0, 0.0, math.inf),
    )
    summary = RunSummary(
        goals=outcomes, contacts=0, min_clearance_m=None, sim_time_s=303.0,
        wall_time_s=30.3, real_time_factor=10.0, seed=0,
        pose_error_m=PoseError(0.0, 0.0),
    )  # fmt: skip
    screen.report(summary, interrupted=False)
    lines = shown.getvalue().splitlines()
    assert lines[:3] == [
        "     0.0 s  ✗ goal (1.0, 2.0) no_path",
        "   303.0 s  ✗ goal (3.0, 4.0) timed_out, 110.0 m left",
        "   303.0 s  ✗ goal (5.0, 6.0) unfinished",
    ]
    assert lines[3].startswith("done: 0 of 3 goals reached")
    assert len(lines) == 4


def reported(**values: Any) -> str:
    """Return the last line of a run with one reached goal."""
    screen = StatusScreen(RunOptions(goals=((1.0, 2.0),)))
    shown = io.StringIO()
    screen._console = Console(file=shown, width=80, force_terminal=False)
    given: dict[str, Any] = {
        "goals": (GoalOutcome((1.0, 2.0), "reached", 3.0, 4.0, 0.1),),
        "contacts": 0,
        "min_clearance_m": None,
        "sim_time_s": 3.0,
        "wall_time_s": 0.3,
        "real_time_factor": 10.0,
        "seed": 0,
        "pose_error_m": PoseError(0.0, 0.0),
        **values,
    }
    screen.report(RunSummary(**given), interrupted=False)
    return shown.getvalue().splitlines()[-1]


def test_a_goal_that_only_the_estimate_reached_is_marked() -> None:
    line = reported(true_goal_distance_m=5.512, pose_error_m=PoseError(5.5, 5.51))
    assert line.startswith(
        "done: 1 of 1 goals reached, by the estimate only (truly up to 5.51 m away, "
        "tolerance 0.5 m), 0 contacts, pose error 5.51 m"
    )
    assert "estimate" not in reported(true_goal_distance_m=0.3)
    line = reported(true_goal_distance_m=0.5021)
    assert "(truly up to 0.5021 m away, tolerance 0.5 m)" in line


def test_a_map_in_another_frame_gives_no_pose_error() -> None:
    line = reported(pose_error_m=PoseError(None, None, map_fits_world=False))
    assert "pose error unknown (the map is not in the world's frame)" in line
    assert "pose unknown" in reported(pose_error_m=PoseError(None, None))


def line_of(progress: RunProgress) -> str:
    screen = StatusScreen(RunOptions())
    shown = io.StringIO()
    screen._console = Console(file=shown, width=80, force_terminal=False)
    run = SimpleNamespace(progress=lambda: progress, real_time_factor=lambda: 1.0)
    screen._console.print(screen._line(run))
    return shown.getvalue()


def test_the_bar_is_empty_without_a_plan() -> None:
    planned = RunProgress(
        goal=(6.2, -3.4), goal_id="1", state="following", control="following",
        distance_left_m=0.0,
    )  # fmt: skip
    assert "━" in line_of(planned)
    assert "0.0 m to (6.2, -3.4)  following" in line_of(planned)
    planning = replace(
        planned, state="planning", control="idle", distance_left_m=None
    )  # fmt: skip
    assert "━" not in line_of(planning)
    assert "─  to (6.2, -3.4)  planning" in line_of(planning)
    failed = replace(planned, state="no_path", control="idle", failed=True)
    assert "━" not in line_of(failed)
    assert "─  to (6.2, -3.4)  no_path" in line_of(failed)
    cancelled = replace(planned, state="canceled", control="idle")
    assert "━" not in line_of(cancelled)
    assert "─  waiting for a goal  idle" in line_of(cancelled)


def test_lines_are_wrapped_at_words_below_their_text() -> None:
    shown = io.StringIO()
    console = Console(
        file=shown, width=40, force_terminal=True, color_system=None, highlight=False
    )
    text = "1 of 1 goals reached, minimum clearance 0.07 m, pose error 0.01 m"
    print_beside(console, Text("done: "), Text(text))
    assert [line.rstrip() for line in shown.getvalue().splitlines()] == [
        "done: 1 of 1 goals reached, minimum",
        "      clearance 0.07 m, pose error 0.01",
        "      m",
    ]
    shown = io.StringIO()
    print_beside(Console(file=shown, width=40), Text("done: "), Text(text))
    assert shown.getvalue() == f"done: {text}\n"


@pytest.mark.parametrize(
    "text", ["35 kernels compiled", "a line of more than 20 columns"]
)
def test_lines_without_a_head_start_at_the_margin(text: str) -> None:
    shown = io.StringIO()
    print_beside(Console(file=shown, width=20, force_terminal=True), Text(), Text(text))
    lines = shown.getvalue().splitlines()
    assert [line.lstrip() for line in lines] == lines
    assert " ".join(map(str.strip, lines)) == text


def test_a_line_breaks_between_its_parts() -> None:
    parts = [Text("0.50 m/s"), Text("→ /cmd_vel_teleop"), Text("EMERGENCY STOP")]
    assert in_rows(parts, 80).plain == "0.50 m/s   → /cmd_vel_teleop   EMERGENCY STOP"
    assert in_rows(parts, 30).plain == "0.50 m/s   → /cmd_vel_teleop\nEMERGENCY STOP"
    assert in_rows(parts, 10).plain.count("\n") == 2


def test_a_retry_is_no_other_goal() -> None:
    screen = StatusScreen(RunOptions())
    shown = io.StringIO()
    screen._console = Console(file=shown, width=80, force_terminal=False)
    goal = RunProgress(goal=(1.0, 2.0), goal_id="1", state="planning")
    again = replace(goal, goal_id="2", retry=1)
    for progress in (
        goal,
        replace(goal, state="stuck", failed=True),
        again,
        replace(again, state="stuck", failed=True),
    ):
        screen.on_change(progress)
    lines = [line.split("s  ", 1)[1] for line in shown.getvalue().splitlines()]
    assert lines == [
        "→ goal (1.0, 2.0)",
        "✗ goal (1.0, 2.0) stuck",
        "→ goal (1.0, 2.0), retry 1",
        "✗ goal (1.0, 2.0) stuck",
    ]


def test_a_goal_that_timed_out_is_one_line_at_its_time() -> None:
    screen = StatusScreen(RunOptions(goals=((1.0, 2.0), (3.0, 4.0))))
    shown = io.StringIO()
    screen._console = Console(file=shown, width=80, force_terminal=False)
    screen.on_change(
        RunProgress(
            goal=(1.0, 2.0), goal_id="1", state="timed_out", failed=True, sim_time_s=3.0
        )
    )
    summary = RunSummary(
        goals=(GoalOutcome((1.0, 2.0), "timed_out", 3.0, 1.0, 9.0),),
        contacts=0, min_clearance_m=None, sim_time_s=6.5, wall_time_s=1.0,
        real_time_factor=6.5, seed=0, pose_error_m=PoseError(0.0, 0.0),
    )  # fmt: skip
    screen.report(summary, interrupted=False)
    first, last = shown.getvalue().splitlines()
    assert first == "     3.0 s  ✗ goal (1.0, 2.0) timed_out"
    assert last.startswith("done: 0 of 2 goals reached")
