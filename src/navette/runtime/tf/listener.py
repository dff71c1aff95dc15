"""Fills a buffer from ``/tf`` and ``/tf_static``."""

import threading
from collections.abc import Callable
from typing import Any

from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.runtime.callback_groups import ReentrantCallbackGroup
from navette.runtime.executor import SingleThreadedExecutor
from navette.runtime.qos import DurabilityPolicy, QoSProfile
from navette.runtime.tf.buffer import Buffer
from navette.runtime.tf.exceptions import TransformException
from navette.runtime.time import stamp_to_ns

_DYNAMIC = QoSProfile(depth=100)
_STATIC = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
# A frame whose stamps go back by more is of another run: a bag that loops, a simulation
# that was reset. Less is a message that came late.
_NEW_RUN_NS = 1_000_000_000
_AUTHORITY = "default_authority"  # what tf2 records: a topic does not tell its sender


class TransformListener:
    """Listens on behalf of ``node`` for as long as it (or the node) lives.

    Its callbacks also run while another callback of the node waits for a transform.
    When the stamps of a frame go back, what moves is forgotten, as it is when the
    node's clock is set back: who plays a bag in a loop may not tell the time.

    Args:
        buffer: anything with tf2's ``set_transform``, ``set_transform_static`` and
            ``clear``.
        spin_thread: let a thread spin the node, for programs that do not. Under a
            virtual clock there is none: time would run away from the program.
        static_only: leave the moving transforms out.
    """

    def __init__(
        self,
        buffer: Any,
        node: Any,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = "/tf",
        tf_static_topic: str = "/tf_static",
        static_only: bool = False,
    ) -> None:
        self.buffer = buffer
        self.node = node
        self.group = ReentrantCallbackGroup()
        self._newest_ns: dict[str, int] = {}
        if isinstance(buffer, Buffer):
            buffer.attach(node)
        self.tf_static_sub = self._subscribe(
            tf_static_topic, self.static_callback, static_qos or _STATIC
        )
        self.tf_sub = None
        if not static_only:
            self.tf_sub = self._subscribe(tf_topic, self.callback, qos or _DYNAMIC)
        if spin_thread and not node.context.clock.is_virtual:
            self._spin_in_thread()

    def unregister(self) -> None:
        """Stop listening."""
        for subscription in (self.tf_static_sub, self.tf_sub):
            if subscription is not None:
                self.node.destroy_subscription(subscription)
        self.tf_static_sub = self.tf_sub = None

    def callback(self, data: TFMessage) -> None:
        """A message of moving transforms."""
        for transform in data.transforms:
            self._watch_stamp(transform)
        self._take(data, self.buffer.set_transform)

    def static_callback(self, data: TFMessage) -> None:
        """A message of static transforms."""
        self._take(data, self.buffer.set_transform_static)

    def _watch_stamp(self, transform: TransformStamped) -> None:
        child, stamp_ns = transform.child_frame_id, stamp_to_ns(transform.header.stamp)
        back_ns = self._newest_ns.get(child, stamp_ns) - stamp_ns
        if back_ns > _NEW_RUN_NS:
            self._newest_ns.clear()
            self.buffer.clear()
            self.node.get_logger().warning(
                f"transforms of {child!r} went back by {back_ns / 1e9:.1f} s: "
                "what moves is forgotten",
                throttle_duration_sec=1.0,
            )
        self._newest_ns[child] = max(stamp_ns, self._newest_ns.get(child, stamp_ns))

    def _subscribe(
        self, topic: str, callback: Callable[[TFMessage], None], qos: QoSProfile | int
    ) -> Any:
        return self.node.create_subscription(
            TFMessage, topic, callback, qos, callback_group=self.group, shared=True
        )

    def _take(
        self, data: TFMessage, store: Callable[[TransformStamped, str], None]
    ) -> None:
        for transform in data.transforms:
            try:
                store(transform, _AUTHORITY)
            except TransformException as error:
                # One sender's bad transform must not stop those who read the rest.
                self.node.get_logger().error(
                    f"ignored a transform: {error}", throttle_duration_sec=1.0
                )

    def _spin_in_thread(self) -> None:
        self.executor = SingleThreadedExecutor(context=self.node.context)
        self.executor.add_node(self.node)
        self.dedicated_listener_thread = threading.Thread(
            target=self.executor.spin, name="tf_listener", daemon=True
        )
        self.dedicated_listener_thread.start()
