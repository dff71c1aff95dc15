"""The stack as processes: it drives, and stops without its controller."""

import os
import signal
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from fleet import PROGRAMS, STACK, Fleet, until

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's"),
]


@pytest.fixture
def fleet(tmp_path: Path) -> Iterator[Fleet]:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with Fleet(tmp_path, {"NAVETTE_ROUTER": f"tcp/127.0.0.1:{port}"}) as made:
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


def stands_within(fleet: Fleet, seconds: float) -> None:
    """The command timeout (0.5 s) and braking, by the robot's own record."""
    begin = fleet.track("speed")[-1]["time"]
    until(lambda: abs(fleet.speed()) < 0.01, "standing")
    assert fleet.track("speed")[-1]["time"] - begin < seconds


def test_the_split_stack_drives_and_stops_without_its_controller(fleet: Fleet) -> None:
    """Course world, six processes: frozen, thawed, killed, started anew, arrived."""
    drive_to(fleet, "missions", -6.0, -12.0)
    control = fleet.running["control"]
    control.send_signal(signal.SIGSTOP)
    stands_within(fleet, 1.5)
    control.send_signal(signal.SIGCONT)
    until(lambda: fleet.speed() > 0.5, "driving again")
    control.send_signal(signal.SIGKILL)
    stands_within(fleet, 1.5)
    fleet.start("control", "navette", "control", "--world", "course")
    until(lambda: fleet.speed() > 0.3, "driving with a new controller")
    until(lambda: fleet.track("planner")[-1]["planner"] == "reached", "the goal")
    x, y = fleet.track("speed")[-1]["x"], fleet.track("speed")[-1]["y"]
    assert ((x + 6.0) ** 2 + (y + 12.0) ** 2) ** 0.5 < 0.6
