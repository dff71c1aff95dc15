"""The nodes under test and the valid messages that are spoiled for them.

Nodes come from the stack's table of stages, inputs and services from the nodes
themselves: a new stage, topic or service is tested without a change here.
"""

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any

from navette.msgs import Message, get_interface
from navette.msgs.copying import copy_message
from navette.navigation.stack import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.stack.simulation import Simulation
from navette.navigation.stack.stage_classes import node_classes
from navette.runtime import (
    Context,
    DurabilityPolicy,
    Node,
    QoSProfile,
    ns_to_stamp,
)
from navette.runtime.testing import GraphHarness
from navette.sim import World, load_robot
from navette.sim.node import SimNode

_LATCHED = DurabilityPolicy.TRANSIENT_LOCAL
_EKF_INPUTS = {
    "odom0": "/odom/filtered",
    "odom1": "/wheels",
    "pose0": "/initialpose",
    "twist0": "/twist",
    "imu0": "/imu",
    "gps0": "/fix",
}
_USED = {
    "odom0": (0, 1, 5),
    "odom1": (6, 11),
    "pose0": (0, 1, 5),
    "twist0": (6, 11),
    "imu0": (5, 11, 12),
}
_EKF: dict[str, Any] = {
    **_EKF_INPUTS,
    **{
        f"{source}_config": [index in used for index in range(15)]
        for source, used in _USED.items()
    },
    "imu0_relative": True,
    "world_frame": "map",
}

_OBSTACLES: dict[str, Any] = {"obstacle_layer.observation_sources": "a b c d"}
for _name, (_source, _kind) in {
    "a": ("/lidar/rear", "LaserScan"),
    "b": ("/depth/points", "PointCloud2"),
    "c": ("/sonar", "Range"),
    "d": ("/hazard_detection", "HazardDetectionVector"),
}.items():
    _OBSTACLES[f"obstacle_layer.{_name}.topic"] = _source
    _OBSTACLES[f"obstacle_layer.{_name}.data_type"] = _kind

#: Parameters with which a stage is tested, by the name of its node; without an entry
#: the stage is tested with its defaults.
VARIANTS: dict[str, tuple[dict[str, Any], ...]] = {
    "costmap": ({}, _OBSTACLES),
    "ekf": (_EKF,),
    # Most searches under extreme parameters fail: at this limit, or 20 times later.
    "planner": ({"max_expansions": 2000},),
    "odom_integrator": (
        {},
        {"topic": "/odom/filtered", "topic_type": "nav_msgs/msg/Odometry"},
        {"topic": "/fix", "topic_type": "sensor_msgs/msg/NavSatFix"},
        {
            "topic": "/twist",
            "topic_type": "geometry_msgs/msg/TwistStamped",
            "odom_type": "vel",
        },
    ),
}


@dataclass(frozen=True)
class Subject:
    """A stage with the parameters of its test."""

    name: str
    node_class: Any
    parameters: Mapping[str, Any] = field(default_factory=dict)

    def make(self, context: Context, **given: Any) -> Node:
        """Create the node; ``given`` are further parameters."""
        values = {**self.parameters, **given}
        if values:
            context.overrides.add(self.name, values, "fuzz")
        if self.node_class is SimNode:
            node: Node = SimNode(_scene(), context=context)
            return node
        made: Node = self.node_class(context=context)
        return made

    def __str__(self) -> str:
        kind = str(self.parameters.get("topic_type", ""))
        return f"{self.name}-{kind.rpartition('/')[2]}" if kind else self.name


SUBJECTS = [
    Subject(name, node_class, parameters)
    for name, node_class in node_classes()
    for parameters in VARIANTS.get(name, ({},))
]


@cache
def _scene() -> Any:
    robot = load_robot("turtlebot3_burger").model
    return World("fuzz").add_walls((6.0, 6.0)).add_robot(robot).scene()


@cache
def recorded() -> dict[str, Message]:
    """Return the last message of every topic of a short drive, by topic."""
    options = RunOptions(
        goals=((-3.0, -7.0),), headless=True, speed=math.inf, max_time_s=3.0
    )
    run = Simulation(options)
    last: dict[str, Message] = {}
    try:
        listener = Node("listener", context=run.context)
        run.executor.add_node(listener)
        for topic, types in run.context.graph.topics().items():
            for durability in (DurabilityPolicy.VOLATILE, _LATCHED):
                listener.create_subscription(
                    get_interface(types[0]),
                    topic,
                    partial(last.__setitem__, topic),
                    QoSProfile(depth=10, durability=durability),
                )
        run.run()
    finally:
        run.close()
    return last


def valid_message(topic: str, message_class: type[Message]) -> Message:
    """Return a valid message: that of a drive, or the defaults of the type."""
    if topic in ("/goal_pose", "/initialpose"):
        return _goal_pose(message_class)
    by_topic = recorded()
    if type(by_topic.get(topic)) is message_class:
        return copy_message(by_topic[topic])
    for msg in by_topic.values():
        if type(msg) is message_class:
            return copy_message(msg)
    made: Any = message_class()
    if hasattr(made, "header"):
        made.header.frame_id = "base_link"
    default: Message = made
    return default


def _goal_pose(message_class: Any) -> Message:
    goal: Any = recorded()["/goal_point"]
    msg = message_class()
    msg.header.frame_id = goal.header.frame_id
    pose = msg.pose.pose if hasattr(msg.pose, "pose") else msg.pose
    pose.position.x, pose.position.y = goal.point.x, goal.point.y
    valid: Message = msg
    return valid


def stamped(msg: Message, now_ns: int) -> Message:
    """Return the message with the present time in its header, if it has one."""
    header: Any = getattr(msg, "header", None)
    if header is not None and hasattr(header, "stamp"):
        header.stamp = ns_to_stamp(now_ns)
    for transform in getattr(msg, "transforms", []):
        transform.header.stamp = ns_to_stamp(now_ns)
    return msg


class Feed:
    """Publishes the valid inputs of a node: transforms first, then in order."""

    def __init__(self, graph: GraphHarness, node: Node) -> None:
        self._graph = graph
        declared = {each.topic: each for each in getattr(node, "INPUTS", ())}
        self._valid: dict[str, Message] = {}
        self._repeated = set()
        for subscription in node.subscriptions:
            topic = subscription.topic_name
            self._valid[topic] = valid_message(topic, subscription.msg_type)
            if topic not in declared or declared[topic].rate_hz is not None:
                self._repeated.add(topic)
        self._order = sorted(self._valid, key=lambda topic: not topic.startswith("/tf"))

    def all(self) -> None:
        """Publish every input once: a goal and a map, too."""
        for topic in self._order:
            self._send(topic)

    def periodic(self) -> None:
        """Publish the inputs that a robot publishes periodically."""
        for topic in self._order:
            if topic in self._repeated:
                self._send(topic)

    def _send(self, topic: str) -> None:
        graph = self._graph
        graph.publish(topic, stamped(self._valid[topic], graph.now_ns), latched=True)


@contextmanager
def running(
    subject: Subject, **parameters: Any
) -> Iterator[tuple[GraphHarness, Node, Feed]]:
    """Run a node that has received each of its inputs."""
    with GraphHarness() as graph:
        overrides = graph.context.overrides
        resolve_scene(RunOptions()).override_parameters(overrides)
        node = graph.add(subject.make(graph.context, **parameters))
        feed = Feed(graph, node)
        feed.all()
        graph.run_for(0.1)
        yield graph, node, feed
