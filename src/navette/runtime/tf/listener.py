"""Subscriber of ``/tf`` and ``/tf_static`` that fills a buffer."""

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
# Stamps that go back by more belong to another run: a bag that loops or a simulation
# that was reset. With a smaller difference a message arrived late.
_NEW_RUN_NS = 1_000_000_000
_AUTHORITY = "default_authority"  # tf2's value for transforms from a topic


class TransformListener:
    """Fills a buffer from the topics of transforms, with subscriptions of ``node``.

    The callbacks also run while another callback of the node waits for a transform. If
    the stamps of a frame jump backward, the moving transforms are cleared, as after a
    jump of the node's clock: a bag may loop without publishing the time.

    Args:
        buffer: an object with tf2's ``set_transform``, ``set_transform_static`` and
            ``clear``.
        spin_thread: spin the node in a thread, for programs that do not spin. Ignored
            with a virtual clock, which would advance without the program.
        static_only: do not subscribe to moving transforms.
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
        for subscription in (self.tf_static_sub, self.tf_sub):
            if subscription is not None:
                self.node.destroy_subscription(subscription)
        self.tf_static_sub = self.tf_sub = None

    def callback(self, data: TFMessage) -> None:
        for transform in data.transforms:
            self._watch_stamp(transform)
        self._store(data, self.buffer.set_transform)

    def static_callback(self, data: TFMessage) -> None:
        self._store(data, self.buffer.set_transform_static)

    def _watch_stamp(self, transform: TransformStamped) -> None:
        child, stamp_ns = transform.child_frame_id, stamp_to_ns(transform.header.stamp)
        back_ns = self._newest_ns.get(child, stamp_ns) - stamp_ns
        if back_ns > _NEW_RUN_NS:
            self._newest_ns.clear()
            self.buffer.clear()
            self.node.get_logger().warning(
                f"stamps of {child!r} jumped backward by {back_ns / 1e9:.1f} s: "
                "moving transforms are cleared",
                throttle_duration_sec=1.0,
            )
        self._newest_ns[child] = max(stamp_ns, self._newest_ns.get(child, stamp_ns))

    def _subscribe(
        self, topic: str, callback: Callable[[TFMessage], None], qos: QoSProfile | int
    ) -> Any:
        return self.node.create_subscription(
            TFMessage, topic, callback, qos, callback_group=self.group, shared=True
        )

    def _store(
        self, data: TFMessage, store: Callable[[TransformStamped, str], None]
    ) -> None:
        for transform in data.transforms:
            try:
                store(transform, _AUTHORITY)
            except TransformException as error:
                # An invalid transform of one publisher must not affect the others.
                self.node.get_logger().error(
                    f"invalid transform ignored: {error}", throttle_duration_sec=1.0
                )

    def _spin_in_thread(self) -> None:
        self.executor = SingleThreadedExecutor(context=self.node.context)
        self.executor.add_node(self.node)
        self.dedicated_listener_thread = threading.Thread(
            target=self.executor.spin, name="tf_listener", daemon=True
        )
        self.dedicated_listener_thread.start()
