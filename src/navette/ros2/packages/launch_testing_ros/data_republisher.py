"""Republisher of changed messages."""

from collections.abc import Callable
from typing import Any

from navette.runtime import Node


class DataRepublisher:
    """Publishes the messages of one topic, changed, on another one.

    Args:
        transform_fn: returns the message to publish, or None for no message.
    """

    def __init__(
        self,
        node: Node,
        listen_topic: str,
        publish_topic: str,
        msg_type: Any,
        transform_fn: Callable[[Any], Any],
    ) -> None:
        self._node = node
        self._transform = transform_fn
        self._received = 0
        self._republished: list[Any] = []
        self._publisher = node.create_publisher(msg_type, publish_topic, 10)
        self._subscription = node.create_subscription(
            msg_type, listen_topic, self._republish, 10
        )

    def shutdown(self) -> None:
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_publisher(self._publisher)

    def get_num_received(self) -> int:
        return self._received

    def get_num_republished(self) -> int:
        return len(self._republished)

    def get_republished(self) -> list[Any]:
        """Return the received messages whose changed ones were published."""
        return self._republished

    def _republish(self, message: Any) -> None:
        self._received += 1
        changed = self._transform(message)
        if changed:
            self._republished.append(message)
            self._publisher.publish(changed)
