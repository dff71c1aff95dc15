"""The whole stack under attack: unusable inputs among those of a driving robot.

The robot's lidar, odometry and transforms pass through a relay, which can replace them.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from fuzz.extremes import Extremes, unusable_numbers
from fuzz.limits import rounds
from fuzz.subjects import recorded, stamped, valid_message
from navette.errors import InvalidInputError
from navette.geometry import Pose2
from navette.msgs import Message
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.stack.stack import NavigationStack
from navette.runtime.input_check import input_check
from navette.runtime.testing import GraphHarness, Probe
from navette.sim.node import SimNode

GOAL = (-3.0, -7.0)
_RELAYED = ("/lidar", "/odom/filtered", "/tf", "/tf_static")
_LATCHED = ("/tf_static", "/map")
#: What a robot's sensors and the stages publish; the others are orders of a person,
#: which replace the goal or stop the robot also if they are refused.
_SENSED = (*_RELAYED, "/costmap", "/map", "/imu", "/camera", "/ground_truth")


class Drive:
    """A robot on its way to a goal, with a relay between its sensors and the stack."""

    def __init__(self, graph: GraphHarness) -> None:
        self.graph = graph
        resolved = resolve_scene(RunOptions(world="arena"))
        resolved.override_parameters(graph.context.overrides)
        graph.context.overrides.add("missions", {"goals_m": list(GOAL)}, "test")
        self.sim = graph.add(SimNode(resolved.scene, context=graph.context))
        self.stack = NavigationStack.create(graph.context)
        for node in graph.context.nodes:
            if node is not self.sim and node is not graph.node:
                graph.add(node)
        self.commands: Probe = graph.collect("/cmd_vel", "geometry_msgs/msg/Twist")
        self.cut: set[str] = set()
        for topic in _RELAYED:
            message = recorded()[topic]
            latched = topic in _LATCHED
            probe = graph.collect(f"/robot{topic}", type(message), latched=latched)
            self._relay(topic, probe)

    def _relay(self, topic: str, probe: Probe) -> None:
        def forward() -> None:
            for msg in probe.messages:
                if topic not in self.cut:
                    self.graph.publish(topic, msg, latched=topic in _LATCHED)
            probe.clear()

        self.graph.node.create_timer(0.01, forward)

    @property
    def speed_mps(self) -> float:
        """True speed of the robot."""
        return math.hypot(*self.sim.simulator.motion().linear[:2])

    def is_done(self) -> bool:
        """Whether the goal has a result."""
        return self.stack.missions.done

    def check(self) -> None:
        """Require: no contact, finite commands."""
        assert self.sim.simulator.contacts.count == 0
        for command in self.commands.messages:
            assert not unusable_numbers(command), command
        self.commands.clear()


@contextmanager
def drive() -> Iterator[Drive]:
    remaps = [f"sim:{topic}:=/robot{topic}" for topic in _RELAYED]
    args = ["--ros-args", *(word for each in remaps for word in ("-r", each))]
    with GraphHarness(args=args) as graph:
        yield Drive(graph)


def unusable(extremes: Extremes, msg: Message, now_ns: int) -> Message | bytes:
    """Return a message that the check of its type refuses, or damaged bytes."""
    valid = stamped(msg, now_ns)
    check = input_check(valid._type_name_)
    for _ in range(8):
        spoiled, _ = extremes.spoiled(valid)
        try:
            check(spoiled)
        except InvalidInputError:
            return spoiled
    return extremes.spoiled_bytes(valid)[0][:-1] + b"\xff\xff\xff"


class Attacker:
    """Publishes unusable messages on topics of the graph."""

    def __init__(self, drive: Drive, seed: int, topics: dict[str, Any]) -> None:
        self._drive = drive
        self._extremes = Extremes(seed)
        self._topics = sorted(topics.items())
        self._publishers: dict[str, Any] = {}
        self.sent = 0
        drive.graph.node.create_timer(0.01, self._attack)

    def _attack(self) -> None:
        graph, extremes = self._drive.graph, self._extremes
        index = int(extremes.rng.integers(len(self._topics)))
        topic, kind = self._topics[index]
        msg = unusable(extremes, valid_message(topic, kind), graph.now_ns)
        self.sent += 1
        if isinstance(msg, bytes):
            publisher = self._publishers.get(topic)
            if publisher is None:
                publisher = graph.node.create_publisher(kind, topic, 10)
                self._publishers[topic] = publisher
            publisher.publish_encoded(msg)
        else:
            graph.publish(topic, msg, latched=topic in _LATCHED)


def topics_of(drive: Drive, *, sensed_only: bool) -> dict[str, Any]:
    """Return the subscribed topics of simulator and stack with their types."""
    graph = drive.graph
    return {
        subscription.topic_name: subscription.msg_type
        for node in graph.context.nodes
        if node is not graph.node
        for subscription in node.subscriptions
        if not sensed_only or subscription.topic_name in _SENSED
    }


def test_a_robot_reaches_its_goal_through_unusable_sensor_data() -> None:
    for seed in rounds():
        with drive() as robot:
            attacker = Attacker(robot, seed, topics_of(robot, sensed_only=True))
            robot.graph.run_until(robot.is_done, 120.0)
            robot.graph.run_for(1.0)  # the attack continues
            robot.check()
            outcomes = robot.stack.missions.outcomes
            assert [each.result for each in outcomes] == ["reached"]
            assert attacker.sent > 500


def test_unusable_inputs_on_every_topic_end_nothing() -> None:
    for seed in rounds():
        with drive() as robot:
            attacker = Attacker(robot, seed, topics_of(robot, sensed_only=False))
            for _ in range(10):
                robot.graph.run_for(1.0)
                robot.check()
            assert attacker.sent >= 999
            dropped = sum(
                sum(node.dropped_inputs.values()) for node in robot.stack.nodes
            )
            assert dropped > 500


@pytest.mark.parametrize(
    ("topics", "stop_s"),
    [
        (("/lidar",), 1.5),
        (("/odom/filtered",), 1.5),
        (("/lidar", "/odom/filtered", "/tf", "/tf_static"), 1.5),
    ],
)
def test_the_robot_stops_if_only_unusable_data_arrives(
    topics: tuple[str, ...], stop_s: float
) -> None:
    with drive() as robot:
        graph = robot.graph
        assert graph.run_until(lambda: robot.speed_mps > 0.4, 30.0)
        kinds = {
            topic: kind
            for topic, kind in topics_of(robot, sensed_only=True).items()
            if topic in topics
        }
        Attacker(robot, 0, kinds)
        robot.cut.update(topics)
        graph.run_for(stop_s)
        assert robot.speed_mps < 0.01
        before: Pose2 = robot.sim.simulator.pose().to_pose2()
        graph.run_for(5.0)
        after = robot.sim.simulator.pose().to_pose2()
        assert math.dist(before[:2], after[:2]) < 0.01
        robot.check()
        robot.cut.clear()  # good data again: the robot continues
        assert graph.run_until(lambda: robot.speed_mps > 0.2, 30.0)
