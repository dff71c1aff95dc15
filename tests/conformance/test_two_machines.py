"""A robot and a laptop: what crosses the wire between them, and what if it fails."""

import itertools
import json
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from fleet import PROGRAMS, STACK, Fleet, until
from two_machines import LAPTOP, ROBOT, Machines, Wire, why_not

REASON = why_not()
pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(REASON), reason=REASON)]


class TwoFleets:
    """Programs on the robot and on the laptop; the router is on the robot."""

    def __init__(self, fleet: Fleet, machines: Machines) -> None:
        self._fleet, self._machines = fleet, machines
        self.said, self.track, self.speed = fleet.said, fleet.track, fleet.speed
        self.standstill = fleet.standstill

    @property
    def wire(self) -> Wire:
        return self._machines.wire

    def robot(self, name: str, *words: str) -> None:
        self._start(self._machines.robot, ROBOT, name, *words)

    def laptop(self, name: str, *words: str) -> None:
        self._start(self._machines.laptop, LAPTOP, name, *words)

    def _start(self, machine: str, address: str, name: str, *words: str) -> None:
        prefix = ("ip", "netns", "exec", machine)
        env = {"NAVETTE_LISTEN": f"tcp/{address}:0"}
        self._fleet.start(name, *words, prefix=prefix, env=env)


@pytest.fixture
def fleet(tmp_path: Path) -> Iterator[TwoFleets]:
    env = {"NAVETTE_ROUTER": f"tcp/{ROBOT}:7447"}
    with Machines(seed=1) as machines, Fleet(tmp_path, env) as programs:
        yield TwoFleets(programs, machines)
        machines.wire.mend()  # a good-bye over a bad wire takes its time


@pytest.fixture
def hasty(tmp_path: Path) -> Iterator[TwoFleets]:
    """Programs that give a link up after two seconds, not ten."""
    config = {
        "scouting": {"multicast": {"enabled": False}},
        "transport": {"link": {"tx": {"lease": 2000}}},
        "connect": {"retry": {"period_init_ms": 50, "period_max_ms": 500}},
    }
    file = tmp_path / "hasty.json5"
    file.write_text(json.dumps(config), encoding="utf-8")
    router = f"tcp/{ROBOT}:7447"
    env = {
        "NAVETTE_ROUTER": router,
        "NAVETTE_RETRANSMIT": "/count",
        "ZENOH_SESSION_CONFIG_URI": str(file),
    }
    with Machines(seed=1, hasty=True) as machines, Fleet(tmp_path, env) as programs:
        yield TwoFleets(programs, machines)
        machines.wire.mend()


def test_what_is_reliable_survives_a_late_lossy_and_broken_wire(
    hasty: TwoFleets,
) -> None:
    fleet = hasty
    fleet.robot("counts", str(PROGRAMS / "count_up.py"))
    fleet.laptop("numbers", str(PROGRAMS / "note_down.py"))

    def numbers() -> list[int]:
        return [int(line) for line in fleet.said("numbers") if line.isdigit()]

    until(lambda: len(numbers()) > 20, "the first numbers")
    fleet.wire.delay_s, fleet.wire.loss = 0.1, 0.05
    worse = len(numbers())
    until(lambda: len(numbers()) > worse + 25, "numbers on a bad wire")
    fleet.wire.is_cut = True
    # Longer than the link lasts: all that is between the two is lost.
    until(lambda: "alone" in fleet.said("numbers"), "the end of the link")
    cut = numbers()[-1]
    fleet.wire.is_cut = False
    until(lambda: numbers()[-1] > cut + 150, "numbers after the cut")
    heard = numbers()
    assert [b - a for a, b in itertools.pairwise(heard)] == [1] * (len(heard) - 1)


def test_the_robot_stops_when_cut_off_and_goes_on_when_it_is_back(
    fleet: TwoFleets,
) -> None:
    fleet.robot("sim", "navette", "sim", "--world", "arena", "--robot", "jackal")
    fleet.robot("track", str(PROGRAMS / "track.py"))
    for stage in STACK:
        fleet.laptop(stage, "navette", stage, "--robot", "jackal")
    until(lambda: bool(fleet.track("planner")), "the planner")
    fleet.laptop("missions", "navette", "missions", "--goal", "-1.0", "-7.0")
    fleet.wire.delay_s, fleet.wire.loss = 0.1, 0.05
    until(lambda: fleet.speed() > 0.5, "driving over a bad wire")
    fleet.wire.is_cut = True
    # The command timeout (0.5 s), braking from cruise speed, a look at the log.
    assert fleet.standstill() < 2.0
    fleet.wire.is_cut = False
    until(lambda: fleet.speed() > 0.3, "driving again")
    far = fleet.track("speed")["x"] + 0.5
    until(lambda: fleet.track("speed")["x"] > far, "half a metre on a bad wire")
    fleet.wire.mend()  # five times as fast
    until(lambda: fleet.track("planner")["planner"] == "reached", "the goal")
    where = fleet.track("speed")
    assert math.dist((where["x"], where["y"]), (-1.0, -7.0)) < 0.6
