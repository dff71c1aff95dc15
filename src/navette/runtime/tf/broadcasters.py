"""Publishers of transforms on ``/tf`` and ``/tf_static``."""

from collections.abc import Iterable
from typing import Any

from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.runtime.qos import DurabilityPolicy, QoSProfile

_STATIC = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TransformBroadcaster:
    """Publisher of moving transforms."""

    def __init__(self, node: Any, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf", qos or 100)

    def sendTransform(  # noqa: N802 - tf2's name
        self, transform: TransformStamped | Iterable[TransformStamped]
    ) -> None:
        self.pub_tf.publish(TFMessage(transforms=_as_list(transform)))

    send_transform = sendTransform


class StaticTransformBroadcaster:
    """Latched publisher of static transforms; each message contains all of them."""

    def __init__(self, node: Any, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", qos or _STATIC)
        self._sent: dict[str, TransformStamped] = {}

    def sendTransform(  # noqa: N802 - tf2's name
        self, transform: TransformStamped | Iterable[TransformStamped]
    ) -> None:
        for one in _as_list(transform):
            self._sent[one.child_frame_id] = one
        self.pub_tf.publish(TFMessage(transforms=list(self._sent.values())))

    send_transform = sendTransform


def _as_list(
    transform: TransformStamped | Iterable[TransformStamped],
) -> list[TransformStamped]:
    return [transform] if isinstance(transform, TransformStamped) else list(transform)
