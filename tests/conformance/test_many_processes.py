"""The stack as processes: drives, and stops without its controller."""

import math
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from fleet import PROGRAMS, STACK, Fleet, until

from free_ports import free_endpoint

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's"),
]

# The command timeout (0.5 s), braking, and the polling period.
STOPS_WITHIN_S = 1.5
GOAL = (-3.0, -7.0)  # 8 m: far enough for the events of the test


@pytest.fixture
def fleet(tmp_path: Path) -> Iterator[Fleet]:
    with Fleet(tmp_path, {"NAVETTE_ROUTER": free_endpoint()}) as made:
        made.start("sim", "navette", "sim", "--world", "course")
        made.start("track", str(PROGRAMS / "track.py"))
        for stage in STACK:
            made.start(stage, "navette", stage, "--world", "course")
        until(lambda: bool(made.track("planner")), "the planner")
        yield made


def drive_to(fleet: Fleet, name: str, x: float, y: float) -> None:
    world = ("--world", "course")
    fleet.start(name, "navette", "missions", *world, "--goal", str(x), str(y))
    until(lambda: fleet.speed() > 0.5, "driving")


def test_the_split_stack_drives_and_stops_without_its_controller(fleet: Fleet) -> None:
    """The controller is stopped, continued, killed and restarted; the robot arrives."""
    drive_to(fleet, "missions", *GOAL)
    control = fleet.running["control"]
    control.send_signal(signal.SIGSTOP)
    assert fleet.standstill() < STOPS_WITHIN_S
    control.send_signal(signal.SIGCONT)
    until(lambda: fleet.speed() > 0.5, "driving again")
    control.send_signal(signal.SIGKILL)
    assert fleet.standstill() < STOPS_WITHIN_S
    fleet.start("control", "navette", "control", "--world", "course")
    until(lambda: fleet.speed() > 0.3, "driving with a new controller")
    until(lambda: fleet.track("planner")["planner"] == "reached", "the goal")
    where = fleet.track("speed")
    assert math.dist((where["x"], where["y"]), GOAL) < 0.6
