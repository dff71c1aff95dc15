"""A robot and a laptop, and failures of the network between them."""

import itertools
import json
import math
from collections.abc import Iterator
from pathlib import Path

import pytest
from fleet import PROGRAMS, STACK, Fleet, until
from two_machines import LAPTOP, ROBOT, Machines, Wire, why_not

REASON = why_not()
pytestmark = [pytest.mark.long, pytest.mark.skipif(bool(REASON), reason=REASON)]


class TwoFleets:
    """Programs on the robot and on the laptop; the robot runs the router."""

    def __init__(self, fleet: Fleet, machines: Machines) -> None:
        self._fleet, self._machines = fleet, machines
        self.output, self.track, self.speed = fleet.output, fleet.track, fleet.speed
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
        machines.wire.restore()  # closing a session over a bad wire takes long


@pytest.fixture
def hasty(tmp_path: Path) -> Iterator[TwoFleets]:
    """Programs that close a silent link after two seconds instead of ten."""
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
        machines.wire.restore()


def test_retransmitted_messages_survive_delay_loss_and_a_cut(
    hasty: TwoFleets,
) -> None:
    fleet = hasty
    fleet.robot("counts", str(PROGRAMS / "count_up.py"))
    fleet.laptop("numbers", str(PROGRAMS / "note_down.py"))

    def numbers() -> list[int]:
        return [int(line) for line in fleet.output("numbers") if line.isdigit()]

    until(lambda: len(numbers()) > 20, "the first numbers")
    fleet.wire.delay_s, fleet.wire.loss = 0.1, 0.05
    worse = len(numbers())
    until(lambda: len(numbers()) > worse + 25, "numbers on a bad wire")
    fleet.wire.is_cut = True
    # Until the link is closed: all samples in its queue are lost.
    until(lambda: "alone" in fleet.output("numbers"), "the end of the link")
    cut = numbers()[-1]
    fleet.wire.is_cut = False
    until(lambda: numbers()[-1] > cut + 150, "numbers after the cut")
    received = numbers()
    assert [b - a for a, b in itertools.pairwise(received)] == [1] * (len(received) - 1)


def test_the_robot_stops_during_a_cut_and_continues_after_it(
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
    # The command timeout (0.5 s), braking from cruise speed, the polling period.
    assert fleet.standstill() < 2.0
    fleet.wire.is_cut = False
    until(lambda: fleet.speed() > 0.3, "driving again")
    far = fleet.track("speed")["x"] + 0.5
    until(lambda: fleet.track("speed")["x"] > far, "half a metre on a bad wire")
    fleet.wire.restore()  # five times as fast
    until(lambda: fleet.track("planner")["planner"] == "reached", "the goal")
    where = fleet.track("speed")
    assert math.dist((where["x"], where["y"]), (-1.0, -7.0)) < 0.6
