"""The state of a stage on the wire: a named result, at once and then regularly."""

from typing import Any

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.runtime.node import Node
from navette.runtime.qos import DurabilityPolicy, QoSProfile

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_PERIOD_S = 0.5


class StatusReporter:
    """Publishes ``diagnostic_msgs/msg/DiagnosticStatus``, latched.

    On a change of state at once; the newest details every half second.

    Args:
        node: publishes and gives its name.
        topic: such as ``/planner/status``.
    """

    OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"

    def __init__(self, node: Node, topic: str) -> None:
        self._status = DiagnosticStatus(name=node.get_name())
        self._publisher = node.create_publisher(DiagnosticStatus, topic, _LATCHED)
        self._timer = node.create_timer(_PERIOD_S, self._repeat)

    @property
    def state(self) -> str:
        """The last state reported; empty before the first."""
        return self._status.message

    def report(self, state: str, level: bytes = OK, **details: Any) -> None:
        """Say what the stage is doing; ``details`` become key/value pairs."""
        status = self._status
        is_new = state != status.message or level != status.level
        status.message, status.level = state, level
        status.values = [
            KeyValue(key=key, value=_text(value)) for key, value in details.items()
        ]
        if is_new:
            self._publisher.publish(status)

    def _repeat(self) -> None:
        if self._status.message:
            self._publisher.publish(self._status)


def _text(value: Any) -> str:
    return f"{value:.3f}" if isinstance(value, float) else str(value)
