"""Count of a stage's dropped messages, logged once per reason, in ``/diagnostics``."""

from collections.abc import Mapping
from types import MappingProxyType

from navette.errors import InvalidInputError
from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import (
    DiagnosticArray,
    DiagnosticStatus,
    KeyValue,
)
from navette.runtime.node import Node
from navette.runtime.publisher import Publisher

_PERIOD_S = 1.0
_LONGEST_TEXT = 300


class DroppedInputs:
    """Counts the dropped messages of a node by topic and reason.

    The first of each topic and reason is logged with its value. From the first on, the
    counts are published on ``/diagnostics`` every second; a node without faults has
    neither publisher nor timer for them.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._counts: dict[tuple[str, str], int] = {}
        self._first: dict[tuple[str, str], str] = {}
        self._publisher: Publisher[DiagnosticArray] | None = None
        self._published_total = 0

    @property
    def counts(self) -> Mapping[tuple[str, str], int]:
        """Number of dropped messages by (topic, reason)."""
        return MappingProxyType(self._counts)

    def add(self, topic: str, error: InvalidInputError) -> None:
        """Count a dropped message; log and publish the first of its kind."""
        kind = (topic, error.reason)
        self._counts[kind] = self._counts.get(kind, 0) + 1
        if self._counts[kind] > 1:
            return
        # Printable, because strings of a message may contain terminal escapes.
        text = repr(str(error))[1:-1][:_LONGEST_TEXT]
        self._first[kind] = text
        self._node.get_logger().warning(
            f"refused {topic}: {text} (more of this kind are only counted, on "
            f"{topics.DIAGNOSTICS.name})"
        )
        if self._publisher is None:
            self._publisher = self._node.create_publisher(
                DiagnosticArray, topics.DIAGNOSTICS.name, topics.DIAGNOSTICS.depth
            )
            self._node.create_timer(_PERIOD_S, self._publish)
        self._publish()

    def _publish(self) -> None:
        assert self._publisher is not None, "created with the first dropped message"
        total = sum(self._counts.values())
        is_new = total > self._published_total
        self._published_total = total
        values = []
        for (topic, reason), count in self._counts.items():
            values.append(KeyValue(key=f"{topic} {reason}", value=str(count)))
            first = self._first[(topic, reason)]
            values.append(KeyValue(key=f"{topic} {reason} first", value=first))
        status = DiagnosticStatus(
            level=DiagnosticStatus.WARN if is_new else DiagnosticStatus.OK,
            name=f"{self._node.get_fully_qualified_name()}: dropped inputs",
            message=f"{total} message{'s' * (total != 1)} dropped",
            values=values,
        )
        array = DiagnosticArray(status=[status])
        array.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(array)
