"""The live line on terminals of several widths."""

import io
from types import SimpleNamespace

import pytest
from rich.console import Console

from navette.cli.status import StatusScreen
from navette.navigation.stack import RunOptions
from navette.navigation.stack.monitor import RunProgress
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
