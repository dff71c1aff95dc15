"""Subscriber of ``/tf`` and ``/tf_static`` that fills a buffer."""

import threading
from collections.abc import Callable
from typing import Any

from navette.errors import InvalidInputError
from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.msgs.values import shortened
from navette.runtime.callback_groups import ReentrantCallbackGroup
from navette.runtime.executor import SingleThreadedExecutor
from navette.runtime.input_check import input_check
from navette.runtime.qos import DurabilityPolicy, QoSProfile
from navette.runtime.tf.buffer import Buffer
from navette.runtime.tf.exceptions import TransformException
from navette.runtime.time import stamp_to_ns

_DYNAMIC = QoSProfile(depth=100)
_STATIC = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
# Stamps that go back by more belong to another run: a bag that loops or a simulation
# that was reset. With a smaller difference a message arrived late.
_NEW_RUN_NS = 1_000_000_000
_check = input_check("geometry_msgs/msg/TransformStamped")
_FAULTS = {"not_finite": "is not finite", "out_of_range": "is out of range"}
_AUTHORITY = "default_authority"  # tf2's value for transforms from a topic


OnInvalid = Callable[[str, InvalidInputError], None]
"""Called with topic and error for each transform that cannot be used."""


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
        on_invalid: receives the transforms that cannot be used, instead of the log.
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
        on_invalid: OnInvalid | None = None,
    ) -> None:
        self.buffer = buffer
        self._on_invalid = on_invalid or self._log_invalid
        self._topics = tf_topic, tf_static_topic
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
        for transform in self._valid(data, self._topics[0]):
            self._watch_stamp(transform)
            self._store(transform, self.buffer.set_transform, self._topics[0])

    def static_callback(self, data: TFMessage) -> None:
        for transform in self._valid(data, self._topics[1]):
            self._store(transform, self.buffer.set_transform_static, self._topics[1])

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

    def _valid(self, data: TFMessage, topic: str) -> list[TransformStamped]:
        """Return the usable transforms: an invalid one must not affect the others."""
        valid = []
        for transform in data.transforms:
            try:
                _check(transform)
            except InvalidInputError as error:
                fault = _FAULTS.get(error.reason, "is invalid")
                child = shortened(transform.child_frame_id)
                detail = f"transform of {child} {fault}: {error.detail}"
                self._on_invalid(topic, InvalidInputError(error.reason, detail))
            else:
                valid.append(transform)
        return valid

    def _store(
        self,
        transform: TransformStamped,
        store: Callable[[TransformStamped, str], None],
        topic: str,
    ) -> None:
        try:
            store(transform, _AUTHORITY)
        except TransformException as error:
            invalid = InvalidInputError("invalid_transform", str(error))
            self._on_invalid(topic, invalid)

    def _log_invalid(self, topic: str, error: InvalidInputError) -> None:
        self.node.get_logger().error(
            f"invalid transform ignored: {error.detail}", throttle_duration_sec=1.0
        )

    def _spin_in_thread(self) -> None:
        self.executor = SingleThreadedExecutor(context=self.node.context)
        self.executor.add_node(self.node)
        self.dedicated_listener_thread = threading.Thread(
            target=self.executor.spin, name="tf_listener", daemon=True
        )
        self.dedicated_listener_thread.start()
