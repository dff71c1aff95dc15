"""Conversions between transform messages and :class:`Transform3`."""

from navette.geometry import Transform3
from navette.msgs.geometry_msgs.msg import (
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from navette.msgs.std_msgs.msg import Header
from navette.runtime.time import ns_to_stamp


def transform_from_msg(message: Transform) -> Transform3:
    t, q = message.translation, message.rotation
    return Transform3((t.x, t.y, t.z), (q.x, q.y, q.z, q.w))


def transform_stamped(
    parent: str, child: str, stamp_ns: int, parent_T_child: Transform3
) -> TransformStamped:
    (x, y, z), (qx, qy, qz, qw) = parent_T_child
    return TransformStamped(
        header=Header(stamp=ns_to_stamp(stamp_ns), frame_id=parent),
        child_frame_id=child,
        transform=Transform(
            translation=Vector3(x=x, y=y, z=z),
            rotation=Quaternion(x=qx, y=qy, z=qz, w=qw),
        ),
    )
