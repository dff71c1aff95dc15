"""A robot and a laptop: what crosses the wire between them, and what if it fails."""

import itertools
import json
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from two_machines import LAPTOP, ROBOT, Machines, why_not

PROGRAMS = Path(__file__).parent / "programs"
ROUTER = f"tcp/{ROBOT}:7447"  # on the robot, in one of its processes
PATIENCE_S = 60.0
STACK = ("costmap", "map_memory", "planner", "control")

REASON = why_not()
pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(REASON), reason=REASON)]


class Fleet:
    """Programs on the two machines, and what they have printed."""

    def __init__(self, folder: Path, machines: Machines) -> None:
        self.wire = machines.wire
        self._machines = machines
        self._folder = folder
        self._running: list[subprocess.Popen[bytes]] = []

    def start(self, machine: str, name: str, *words: str) -> None:
        address = ROBOT if machine == self._machines.robot else LAPTOP
        env = {
            "NAVETTE_TRANSPORT": "zenoh",
            "NAVETTE_ROUTER": ROUTER,
            "NAVETTE_LISTEN": f"tcp/{address}:0",
            "ROS_DOMAIN_ID": "7",
            "PYTHONUNBUFFERED": "1",
        }
        command = [sys.executable, "-m", "navette", "run", *words]
        log = str(self._folder / name)
        process = self._machines.start(machine, command, env=env, log=log)
        self._running.append(process)

    def robot(self, name: str, *words: str) -> None:
        self.start(self._machines.robot, name, *words)

    def laptop(self, name: str, *words: str) -> None:
        self.start(self._machines.laptop, name, *words)

    def said(self, name: str) -> list[str]:
        """The whole lines that a program printed so far."""
        text = (self._folder / name).read_text(encoding="utf-8")
        return text[: text.rfind("\n") + 1].splitlines()

    def until(self, check: Callable[[], bool], what: str) -> None:
        """Look again and again; real programs have no virtual clock."""
        pause = threading.Event()
        for _ in range(round(PATIENCE_S / 0.05)):
            if check():
                return
            pause.wait(0.05)
        raise AssertionError(f"not within {PATIENCE_S} s: {what}")

    def end(self) -> None:
        for process in self._running:
            process.send_signal(signal.SIGINT)
        for process in self._running:
            process.wait(20.0)


@pytest.fixture
def fleet(tmp_path: Path) -> Iterator[Fleet]:
    with Machines(seed=1) as machines:
        made = Fleet(tmp_path, machines)
        try:
            yield made
        finally:
            made.end()


def test_what_is_reliable_survives_a_late_lossy_and_broken_wire(fleet: Fleet) -> None:
    fleet.robot("counts", str(PROGRAMS / "count_up.py"))
    fleet.laptop("numbers", str(PROGRAMS / "note_down.py"))

    def numbers() -> list[int]:
        return [int(line) for line in fleet.said("numbers")]

    fleet.until(lambda: len(numbers()) > 20, "the first numbers")
    fleet.wire.delay_s, fleet.wire.loss = 0.1, 0.05
    worse = len(numbers())
    fleet.until(lambda: len(numbers()) > worse + 100, "numbers on a bad wire")
    fleet.wire.is_cut = True
    lost = fleet.wire.lost
    fleet.until(lambda: fleet.wire.lost > lost + 20, "packets lost")
    cut = numbers()[-1]
    fleet.wire.is_cut = False
    fleet.until(lambda: numbers()[-1] > cut + 150, "numbers after the cut")
    heard = numbers()
    assert [b - a for a, b in itertools.pairwise(heard)] == [1] * (len(heard) - 1)


def test_the_robot_stops_when_cut_off_and_goes_on_when_it_is_back(
    fleet: Fleet,
) -> None:
    fleet.robot("sim", "navette", "sim", "--world", "arena", "--robot", "jackal")
    fleet.robot("track", str(PROGRAMS / "track.py"))
    for stage in STACK:
        fleet.laptop(stage, "navette", stage, "--robot", "jackal")

    def track(key: str) -> list[Any]:
        said = (line for line in fleet.said("track") if f'"{key}"' in line)
        return [json.loads(line) for line in said if line.startswith("{")]

    fleet.until(lambda: bool(track("planner")), "the planner")
    fleet.laptop("missions", "navette", "missions", "--goal", "-1.0", "-7.0")
    fleet.wire.delay_s, fleet.wire.loss = 0.1, 0.05

    def speed() -> float:
        return float(track("speed")[-1]["speed"])

    fleet.until(lambda: speed() > 0.5, "driving over a bad wire")
    fleet.wire.is_cut = True
    cut = track("speed")[-1]["time"]
    fleet.until(lambda: abs(speed()) < 0.01, "standing")
    stood = track("speed")[-1]["time"]
    # The command timeout (0.5 s), braking from cruise speed, a look at the log.
    assert stood - cut < 2.0
    fleet.wire.is_cut = False
    fleet.until(lambda: speed() > 0.3, "driving again")
    fleet.until(lambda: track("planner")[-1]["planner"] == "reached", "the goal")
    x, y = track("speed")[-1]["x"], track("speed")[-1]["y"]
    assert ((x + 1.0) ** 2 + (y + 7.0) ** 2) ** 0.5 < 0.6
