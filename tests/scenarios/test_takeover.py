"""Operator, emergency stop and cancel in the whole stack."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import Twist, TwistStamped, Vector3
from navette.msgs.std_msgs.msg import Bool, Empty
from navette.navigation.stack.simulation import Simulation
from navette.runtime import DurabilityPolicy, Node, QoSProfile

from .conftest import MakeSimulation

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Operator:
    """A node beside a run in free space that drives to a goal 9 m ahead."""

    def __init__(self, simulate: MakeSimulation, **options: object) -> None:
        self.run: Simulation = simulate(world="empty", **options)
        self.missions = self.run.stack.missions
        self.missions.add_goal(9.0, 0.0)
        self.node = Node("pilot", context=self.run.context)
        self.run.executor.add_node(self.node)
        self.states: dict[str, str] = {}
        for topic in ("/commander", "/planner/status", "/control/status"):
            self.node.create_subscription(
                DiagnosticStatus, topic, self._note(topic), LATCHED
            )
        self._publishers: dict[tuple[str, type], object] = {}
        self.spin(4.0)
        assert self.commander == "navigation"
        assert self.speed > 0.8

    def _note(self, topic: str) -> Callable[[DiagnosticStatus], None]:
        return lambda msg: self.states.update({topic: msg.message})

    @property
    def commander(self) -> str:
        return self.states["/commander"]

    @property
    def speed(self) -> float:
        motion = self.run.sim.simulator.motion()
        return math.hypot(motion.linear[0], motion.linear[1])

    @property
    def turn_rate(self) -> float:
        return self.run.sim.simulator.motion().angular[2]

    def spin(self, seconds: float) -> None:
        self.run.executor.spin_for(round(seconds * 1e9))

    def send(self, topic: str, msg: object) -> None:
        key = topic, type(msg)
        if key not in self._publishers:
            self._publishers[key] = self.node.create_publisher(type(msg), topic, 10)
        self._publishers[key].publish(msg)

    def hold(self, topic: str, turn: float, seconds: float) -> None:
        """Turn in place: a command each 50 ms."""
        for _ in range(round(seconds * 20)):
            self.send(topic, Twist(angular=Vector3(z=turn)))
            self.spin(0.05)

    @property
    def results(self) -> list[str]:
        return [outcome.result for outcome in self.missions.outcomes]

    def arrive(self) -> None:
        """Run until the newest goal is reached."""
        limit_ns = 60_000_000_000
        self.run.executor.spin_until_complete(lambda: self.missions.done, limit_ns)
        assert self.results[-1] == "reached"
        assert self.run.summary().contacts == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("topic", "commander"),
    [("/cmd_vel_teleop", "operator"), ("/cmd_vel", "external")],
)
def test_a_takeover_pauses_navigation_which_resumes_and_arrives(
    simulate: MakeSimulation, impatient: Path, topic: str, commander: str
) -> None:
    operator = Operator(simulate, params_files=(impatient,))
    operator.hold(topic, 0.8, 6.0)  # longer than every timeout of progress
    assert operator.states == {
        "/commander": commander,
        "/planner/status": "paused",
        "/control/status": "paused",
    }
    assert operator.turn_rate == pytest.approx(0.8, abs=0.1)
    assert operator.speed < 0.05
    operator.spin(0.8)  # let go
    assert (operator.speed, operator.turn_rate) == pytest.approx((0, 0), abs=0.02)
    operator.arrive()


@pytest.mark.slow
def test_a_takeover_may_end_the_goal(simulate: MakeSimulation, tmp_path) -> None:
    file = tmp_path / "end.yaml"
    file.write_text("arbiter: {ros__parameters: {after_takeover: end}}")
    operator = Operator(simulate, params_files=(file,))
    operator.hold("/cmd_vel_teleop", 0.0, 3.0)
    operator.spin(3.0)
    assert (operator.commander, operator.speed < 0.01) == ("idle", True)
    assert operator.results == ["canceled"]


@pytest.mark.slow
def test_nothing_moves_a_stopped_robot_until_the_release(
    simulate: MakeSimulation,
) -> None:
    operator = Operator(simulate)
    operator.send("/emergency_stop", Bool(data=True))
    operator.spin(0.5)
    assert operator.speed < 0.01
    ahead = Twist(linear=Vector3(x=0.5))
    for _ in range(100):
        for topic in ("/cmd_vel", "/cmd_vel_teleop", "/cmd_vel_nav"):
            operator.send(topic, ahead)
            operator.send(topic, TwistStamped(twist=ahead))
        operator.send("/emergency_stop", Bool(data=False))  # not a release
        operator.spin(0.05)
        assert operator.speed < 0.01
    assert operator.commander == "emergency_stop"
    operator.spin(2.0)
    operator.send("/emergency_stop/release", Empty())
    operator.arrive()


@pytest.mark.slow
def test_cancel_stops_the_robot_and_ends_every_goal(simulate: MakeSimulation) -> None:
    operator = Operator(simulate)
    operator.missions.add_goal(0.0, 0.0)
    operator.send("/cancel_goal", Empty())
    operator.spin(3.0)
    assert (operator.speed, operator.commander) == (pytest.approx(0, abs=0.01), "idle")
    assert operator.results == ["canceled", "skipped"]
    operator.missions.add_goal(9.0, 0.0)
    operator.arrive()
