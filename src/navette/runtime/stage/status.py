"""Status of a stage, published on every change and periodically."""

from functools import partial
from typing import Any

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.runtime.stage.stage_node import Output, StageNode

_PERIOD_S = 0.5


def spelled(state: str) -> str:
    """Return a state as texts spell it; ``canceled`` is published as in ROS."""
    return "cancelled" if state == "canceled" else state


def status_output(topic: str) -> Output:
    """Return the output that a stage declares for its :class:`StatusReporter`."""
    return Output(
        topic=topic,
        type="diagnostic_msgs/msg/DiagnosticStatus",
        role="named status of the stage with details",
        rate_hz=1 / _PERIOD_S,
        depth=1,
        latched=True,
    )


class StatusReporter:
    """Publisher of the status as ``diagnostic_msgs/msg/DiagnosticStatus``, latched.

    A change of state is published immediately, the newest details every 0.5 s.

    Args:
        node: the node that publishes; its name is the status' name.
        topic: an output of the node, made by :func:`status_output`.
    """

    OK, WARN, ERROR = b"\x00", b"\x01", b"\x02"

    def __init__(self, node: StageNode, topic: str) -> None:
        self._status = DiagnosticStatus(name=node.get_name())
        self._cause = ""
        self._details: dict[str, Any] = {}
        self._publish = partial(node.publish, topic)
        self._timer = node.create_timer(_PERIOD_S, self._repeat)

    @property
    def state(self) -> str:
        """The last reported state; empty before the first report."""
        return self._status.message

    def report(
        self, state: str, level: bytes = OK, *, cause: str = "", **details: Any
    ) -> None:
        """Set the state; ``details`` become key-value pairs.

        A change of ``cause`` is published at once, as one of the state is.
        """
        status = self._status
        is_new = (state, level, cause) != (status.message, status.level, self._cause)
        status.message, status.level, self._cause = state, level, cause
        self._details = details
        if is_new:
            self._publish_newest()

    def _repeat(self) -> None:
        if self._status.message:
            self._publish_newest()

    def _publish_newest(self) -> None:
        # Stages report in each step; most of the reports are replaced by the next one.
        self._status.values = [
            KeyValue(key=key, value=_text(value))
            for key, value in self._details.items()
        ]
        self._publish(self._status)


def _text(value: Any) -> str:
    return f"{value:.3f}" if isinstance(value, float) else str(value)
