"""The arbiter in a graph."""

from collections.abc import Iterator

import pytest

from navette.errors import ParameterError
from navette.msgs.ackermann_msgs.msg import AckermannDriveStamped
from navette.msgs.geometry_msgs.msg import Twist, TwistStamped, Vector3
from navette.msgs.std_msgs.msg import Bool, Empty
from navette.navigation.arbiter.node import ArbiterNode
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness


def twist(speed: float = 0.0, turn: float = 0.0) -> Twist:
    return Twist(linear=Vector3(x=speed), angular=Vector3(z=turn))


class Bench:
    """An arbiter, its output and its status."""

    def __init__(self, graph: GraphHarness, **params: object) -> None:
        self.graph = graph
        given = [Parameter(n.replace("__", "."), value=v) for n, v in params.items()]
        self.node = graph.add(
            ArbiterNode(context=graph.context, parameter_overrides=given)
        )
        stamped = bool(params.get("use_stamped"))
        self.commands = graph.collect("/cmd_vel", TwistStamped if stamped else Twist)
        self.status = graph.collect(
            "/commander", "diagnostic_msgs/msg/DiagnosticStatus", latched=True
        )
        self.graph.run_for(0.01)

    def send(self, topic: str, msg: object) -> list[float]:
        """Publish, and return the speeds that reach the wheels in the same instant."""
        before = self.commands.count
        self.graph.publish(topic, msg)
        self.graph.run_for(1e-9)
        return [m.linear.x for m in self.commands.messages[before:]]

    @property
    def commander(self) -> str:
        return str(self.status.last.message)

    def value(self, key: str) -> str:
        return {pair.key: pair.value for pair in self.status.last.values}[key]


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


@pytest.fixture
def bench(graph: GraphHarness) -> Bench:
    return Bench(graph)


def test_the_operator_takes_over_in_the_same_instant(bench: Bench) -> None:
    assert bench.commander == "idle"
    assert bench.send("/cmd_vel_nav", twist(0.3)) == [0.3]
    assert bench.commander == "navigation"
    assert bench.send("/cmd_vel_teleop", twist(-0.1)) == [-0.1]
    assert bench.commander == "operator"
    assert bench.value("nodes") == "/harness"
    assert (
        bench.value("masked_topics") == "/cmd_vel,/drive,/cmd_vel_reflex,/cmd_vel_nav"
    )
    assert bench.send("/cmd_vel_nav", twist(0.3)) == []


@pytest.mark.parametrize("topic", ["/cmd_vel_nav", "/cmd_vel_teleop"])
def test_every_input_takes_twist_stamped_too(bench: Bench, topic: str) -> None:
    assert bench.send(topic, TwistStamped(twist=twist(0.2))) == [0.2]


def test_the_output_may_be_stamped(graph: GraphHarness) -> None:
    bench = Bench(graph, use_stamped=True, base_frame="base_footprint")
    graph.publish("/cmd_vel_teleop", twist(0.2))
    graph.run_for(0.01)
    assert bench.commands.last.twist.linear.x == 0.2
    assert bench.commands.last.header.frame_id == "base_footprint"


def test_a_silent_operator_stops_the_robot_at_its_timeout(bench: Bench) -> None:
    bench.send("/cmd_vel_teleop", twist(0.3))
    start_ns = bench.commands.stamps_ns[-1]
    bench.graph.run_for(0.6)
    stop = next(i for i, m in enumerate(bench.commands.messages) if m == Twist())
    assert bench.commands.stamps_ns[stop] - start_ns == 500_000_000
    assert bench.commander == "operator"  # holds
    bench.graph.run_for(1.0)
    assert bench.commander == "idle"


def test_a_program_that_publishes_the_output_masks_navigation(bench: Bench) -> None:
    bench.send("/cmd_vel_nav", twist(0.3))
    assert bench.send("/cmd_vel", twist(0.1)) == [0.1]  # its own
    assert bench.commander == "external"
    assert bench.value("nodes") == "/harness"
    assert bench.send("/cmd_vel_nav", twist(0.3)) == []
    assert bench.send("/cmd_vel_teleop", twist(-0.1)) == [-0.1]
    assert bench.send("/cmd_vel", twist(0.1)) == [0.1, -0.1]  # overruled


def test_a_program_that_steers_a_car_masks_navigation(bench: Bench) -> None:
    """On ``/drive`` the command reaches the wheels without the arbiter."""
    steered = AckermannDriveStamped()
    steered.drive.speed, steered.drive.steering_angle = 0.5, 0.1
    bench.send("/cmd_vel_nav", twist(0.3))
    assert bench.send("/drive", steered) == []
    assert (bench.commander, bench.value("nodes")) == ("drive", "/harness")
    assert bench.send("/cmd_vel_nav", twist(0.3)) == []
    assert bench.send("/cmd_vel_teleop", twist(-0.1)) == [-0.1]
    assert bench.commander == "operator"
    assert bench.send("/drive", steered) == [-0.1]  # overruled
    bench.send("/emergency_stop", Bool(data=True))
    assert bench.send("/drive", steered) == [0.0]
    assert bench.commander == "emergency_stop"


def test_a_car_stops_when_the_program_that_steers_it_stops_publishing(
    bench: Bench,
) -> None:
    bench.send("/drive", AckermannDriveStamped())
    bench.graph.run_for(0.6)
    assert bench.commands.last == Twist()
    bench.graph.run_for(1.0)
    assert bench.commander == "idle"


def test_the_emergency_stop_latches(bench: Bench) -> None:
    bench.send("/cmd_vel_teleop", twist(0.3))
    assert bench.send("/emergency_stop", Bool(data=True)) == [0.0]
    bench.send("/emergency_stop", Bool(data=False))  # not a release
    assert bench.commander == "emergency_stop"
    assert bench.send("/cmd_vel_teleop", twist(0.3)) == []
    assert bench.send("/cmd_vel", twist(0.3)) == [0.3, 0.0]
    bench.graph.run_for(60.0)
    assert bench.commander == "emergency_stop"
    bench.send("/emergency_stop/release", Empty())
    assert bench.commander == "idle"
    assert bench.send("/cmd_vel_teleop", twist(0.3)) == [0.3]


def test_a_restarted_arbiter_learns_of_the_robots_stop(graph: GraphHarness) -> None:
    graph.publish("/emergency_stop/active", Bool(data=True), latched=True)
    bench = Bench(graph)
    assert bench.commander == "emergency_stop"
    graph.publish("/emergency_stop/active", Bool(data=False), latched=True)
    graph.run_for(0.01)
    assert bench.commander == "idle"


def test_sources_and_locks_are_parameters_named_as_in_twist_mux(
    graph: GraphHarness,
) -> None:
    bench = Bench(
        graph,
        topics__joystick__topic="joy_vel",
        topics__joystick__timeout=0.2,
        topics__joystick__priority=90,
        topics__navigation__priority=30,
        topics__external__topic="",
        locks__door__topic="door_open",
        locks__door__priority=40,
    )
    assert bench.send("/joy_vel", twist(0.1)) == [0.1]
    assert bench.commander == "joystick"
    bench.graph.run_for(0.2)
    assert bench.commands.last == Twist()
    bench.send("/door_open", Bool(data=True))
    assert bench.commander == "door"
    assert bench.send("/cmd_vel_nav", twist(0.1)) == []
    names = {p.topic for p in bench.node.INPUTS} - {"/cmd_vel"}
    assert bench.node.get_parameter("topics.navigation.priority").value == 30
    assert "/cmd_vel_teleop" in names


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("topics.operator.priority", 256, "priority.*256.*255"),
        ("topics.operator.timeout", -1.0, "timeout"),
        ("topics.operator.prio", 3, "no parameter 'topics.operator.prio'"),
        ("locks.pause.topic", 3, "topic"),
    ],
)
def test_a_wrong_parameter_is_named(
    graph: GraphHarness, name: str, value: object, error: str
) -> None:
    with pytest.raises(ParameterError, match=error):
        ArbiterNode(
            context=graph.context, parameter_overrides=[Parameter(name, value=value)]
        )


def test_a_command_over_the_limits_is_named(graph: GraphHarness) -> None:
    bench = Bench(graph, max_speed_mps=0.5)
    assert bench.send("/cmd_vel_nav", twist(1.0)) == [0.0]
    assert bench.value("refused") == "command_over_limit"
    assert bench.send("/cmd_vel_teleop", twist(1.0)) == [0.5]


def test_the_robot_stops_when_the_arbiter_is_destroyed(bench: Bench) -> None:
    bench.send("/cmd_vel_nav", twist(0.3))
    bench.node.destroy_node()
    bench.graph.run_for(0.01)
    assert bench.commands.last == Twist()


@pytest.mark.parametrize(
    ("parameter", "topic", "msg"),
    [
        ("after_takeover", "/cmd_vel_teleop", Twist()),
        ("after_takeover", "/cmd_vel", Twist()),
        ("after_stop", "/emergency_stop", Bool(data=True)),
    ],
)
@pytest.mark.parametrize("value", ["resume", "end"])
def test_navigations_goal_may_end_with_the_takeover(
    graph: GraphHarness, parameter: str, topic: str, msg: object, value: str
) -> None:
    bench = Bench(graph, **{parameter: value})
    cancels = graph.collect("/cancel_goal", "std_msgs/msg/Empty")
    bench.send(topic, msg)
    bench.send(topic, msg)
    assert cancels.count == (value == "end")


def test_a_stop_during_a_takeover_may_end_the_goal(graph: GraphHarness) -> None:
    bench = Bench(graph, after_stop="end")
    cancels = graph.collect("/cancel_goal", "std_msgs/msg/Empty")
    bench.send("/cmd_vel_teleop", twist(0.1))
    assert cancels.count == 0
    bench.send("/emergency_stop", Bool(data=True))
    assert cancels.count == 1
