"""Fills a buffer from ``/tf`` and ``/tf_static``."""

from typing import Any

from navette.msgs.tf2_msgs.msg import TFMessage
from navette.runtime.callback_groups import ReentrantCallbackGroup
from navette.runtime.qos import DurabilityPolicy, QoSProfile
from navette.runtime.tf.buffer import Buffer
from navette.runtime.tf.exceptions import TransformException

_DYNAMIC = QoSProfile(depth=100)
_STATIC = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TransformListener:
    """Listens on behalf of ``node`` for as long as it (or the node) lives.

    Its callbacks also run while another callback of the node waits for a transform.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: Any,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | None = None,
        static_qos: QoSProfile | None = None,
        tf_topic: str = "/tf",
        tf_static_topic: str = "/tf_static",
        static_only: bool = False,
    ) -> None:
        self.buffer = buffer
        self._node = node
        group = ReentrantCallbackGroup()
        self._subscriptions = [
            node.create_subscription(
                TFMessage,
                tf_static_topic,
                self.static_callback,
                static_qos or _STATIC,
                callback_group=group,
                shared=True,
            )
        ]
        if not static_only:
            self._subscriptions.append(
                node.create_subscription(
                    TFMessage,
                    tf_topic,
                    self.callback,
                    qos or _DYNAMIC,
                    callback_group=group,
                    shared=True,
                )
            )

    def unregister(self) -> None:
        """Stop listening."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions.clear()

    def callback(self, data: TFMessage) -> None:
        """A message of moving transforms."""
        self._take(data, self.buffer.set_transform)

    def static_callback(self, data: TFMessage) -> None:
        """A message of static transforms."""
        self._take(data, self.buffer.set_transform_static)

    def _take(self, data: TFMessage, store: Any) -> None:
        for transform in data.transforms:
            try:
                store(transform)
            except TransformException as error:
                # One sender's bad transform must not stop those who read the rest.
                self._node.get_logger().error(
                    f"ignored a transform: {error}", throttle_duration_sec=1.0
                )
