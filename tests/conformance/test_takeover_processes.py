"""Operators and foreign programs in processes of their own, over Zenoh."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from fleet import PROGRAMS, Fleet, until

from free_ports import free_endpoint

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's"),
]

CRATE_AT_M = 1.5
_BOX = "<geometry><box><size>0.5 0.8 0.5</size></box></geometry>"
CRATE = f"""
<sdf version="1.9"><world name="crate">
  <model name="ground"><static>true</static><link name="link">
    <collision name="c"><geometry><plane><normal>0 0 1</normal></plane></geometry>
    </collision></link></model>
  <model name="crate"><static>true</static><pose>{CRATE_AT_M + 0.25} 0 0.25 0 0 0</pose>
    <link name="link">
      <collision name="c">{_BOX}</collision><visual name="v">{_BOX}</visual>
    </link></model>
</world></sdf>
"""
# The arbiter's timeout of the operator, braking, and the polling period.
STOPS_WITHIN_S = 1.5


@pytest.fixture
def fleet(tmp_path: Path) -> Iterator[Fleet]:
    with Fleet(tmp_path, {"NAVETTE_ROUTER": free_endpoint()}) as made:
        yield made


def start_robot(fleet: Fleet, robot: str, world: str) -> None:
    words = ("--world", world, "--robot", robot, "--start", "0", "0", "0")
    fleet.start("sim", "navette", "sim", *words)
    fleet.start("track", str(PROGRAMS / "track.py"))
    until(lambda: bool(fleet.track("speed")), "the robot")


@pytest.mark.parametrize("kind", ["plain", "stamped"])
def test_a_program_for_the_turtlebot3_stops_before_a_crate(
    fleet: Fleet, tmp_path: Path, kind: str
) -> None:
    world = tmp_path / "crate.sdf"
    world.write_text(CRATE)
    start_robot(fleet, "burger", str(world))
    fleet.start("program", str(PROGRAMS / "stop_ahead.py"), kind)
    until(lambda: fleet.speed() > 0.15, "driving")
    until(lambda: any("obstacle ahead" in x for x in fleet.output("program")), "a stop")
    fleet.standstill()
    # The scanner is 3 cm behind the axle; the front of the body is 4 cm ahead of it.
    assert 0.3 < CRATE_AT_M - fleet.track("speed")["x"] < 0.52
    assert not any("contact" in line for line in fleet.output("sim"))


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGSTOP])
@pytest.mark.parametrize("topic", ["/cmd_vel_teleop", "/cmd_vel"])
def test_the_robot_stops_when_its_operator_is_killed_or_frozen(
    fleet: Fleet, end: signal.Signals, topic: str
) -> None:
    start_robot(fleet, "jackal", "empty")
    fleet.start("arbiter", "navette", "arbiter", "--robot", "jackal")
    fleet.start("hold", str(PROGRAMS / "hold.py"), topic, "0.4")
    until(lambda: fleet.speed() > 0.35, "driving")
    fleet.running["hold"].send_signal(end)
    assert fleet.standstill() < STOPS_WITHIN_S


def test_the_robot_stops_when_the_arbiter_is_killed_and_stays_stopped(
    fleet: Fleet,
) -> None:
    """An emergency stop outlives the arbiter: a new one reports it."""
    start_robot(fleet, "jackal", "empty")
    fleet.start("arbiter", "navette", "arbiter", "--robot", "jackal")
    fleet.start("hold", str(PROGRAMS / "hold.py"), "/cmd_vel_teleop", "0.4")
    until(lambda: fleet.speed() > 0.35, "driving")
    fleet.running["arbiter"].send_signal(signal.SIGKILL)
    assert fleet.standstill() < STOPS_WITHIN_S
    fleet.start("arbiter", "navette", "arbiter", "--robot", "jackal")
    until(lambda: fleet.speed() > 0.35, "driving with a new arbiter")
    verb = fleet.verb("stop")
    assert verb == "robot: stopped until: navette stop --release\n"
    assert fleet.standstill() < STOPS_WITHIN_S
    fleet.running["arbiter"].send_signal(signal.SIGKILL)
    fleet.start("arbiter", "navette", "arbiter", "--robot", "jackal")
    until(lambda: "emergency_stop" in fleet.verb("topic", "echo", "/commander",
          "--once", "--field", "message"), "the new arbiter")  # fmt: skip
    assert abs(fleet.speed()) < 0.01
    assert fleet.verb("stop", "--release") == "robot: released\n"
    until(lambda: fleet.speed() > 0.35, "driving after the release")
