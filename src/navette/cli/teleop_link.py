"""Connection of ``navette teleop`` to a robot: commands, stop, who commands."""

from typing import Any

from navette.cli.session import endpoints
from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import Twist, TwistStamped
from navette.msgs.std_msgs.msg import Bool, Empty
from navette.runtime import DurabilityPolicy, Node, Publisher, QoSProfile
from navette.runtime.stage.commander import Commander
from navette.runtime.time import ns_to_stamp
from navette.transports import EndpointKind

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TeleopLink:
    """Publishes an operator's commands where a node subscribes to them.

    Args:
        topic: topic of the commands; empty: the operator's topic of an arbiter, or that
            of the robot where no arbiter runs.
    """

    def __init__(self, node: Node, topic: str) -> None:
        self._node = node
        operator, robot = topics.CMD_VEL_TELEOP.name, topics.CMD_VEL.name
        self._candidates = [topic] if topic else [operator, robot]
        self._publishers: dict[tuple[str, type], Publisher[Any]] = {}
        self._stop = node.create_publisher(Bool, topics.EMERGENCY_STOP.name, 1)
        release = topics.EMERGENCY_STOP_RELEASE.name
        self._release = node.create_publisher(Empty, release, 1)
        self.commander = Commander()
        node.create_subscription(
            DiagnosticStatus, topics.COMMANDER.name, self._on_commander, _LATCHED
        )

    @property
    def wanted(self) -> str:
        """The topics that are tried, for messages."""
        return " or ".join(self._candidates)

    @property
    def topic(self) -> str:
        """The topic on which commands arrive somewhere; empty if there is none."""
        return self._destination()[0]

    def drive(self, speed_mps: float, turn_radps: float) -> None:
        """Publish a command."""
        topic, kind = self._destination()
        if not topic:
            return
        publisher = self._publishers.get((topic, kind))
        if publisher is None:
            publisher = self._node.create_publisher(kind, topic, 1)
            self._publishers[topic, kind] = publisher
        twist = Twist()
        twist.linear.x, twist.angular.z = speed_mps, turn_radps
        publisher.publish(twist if kind is Twist else self._stamped(twist))

    def stop(self) -> None:
        """Engage the emergency stop."""
        self._stop.publish(Bool(data=True))

    def release(self) -> None:
        """Release the emergency stop."""
        self._release.publish(Empty())

    def _destination(self) -> tuple[str, type]:
        """Return the first topic with a subscription, and its type."""
        for topic in self._candidates:
            name = self._node.resolve_topic_name(topic)
            ends = endpoints(self._node, name, kind=EndpointKind.SUBSCRIPTION)
            kinds = {each.type_name for each in ends}
            if topics.CMD_VEL.type in kinds:
                return name, Twist
            if kinds:
                return name, TwistStamped
        return "", Twist

    def _stamped(self, twist: Twist) -> TwistStamped:
        msg = TwistStamped(twist=twist)
        msg.header.stamp = ns_to_stamp(self._node.get_clock().now_ns)
        return msg

    def _on_commander(self, msg: DiagnosticStatus) -> None:
        self.commander = Commander.of(msg)
