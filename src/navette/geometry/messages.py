"""Stamps, frames and transforms as messages."""

from navette.geometry.se3 import Transform3
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.geometry_msgs.msg import (
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from navette.msgs.std_msgs.msg import Header


def time_message(stamp_ns: int) -> Time:
    """Return a stamp as a message."""
    seconds, nanoseconds = divmod(stamp_ns, 1_000_000_000)
    return Time(sec=seconds, nanosec=nanoseconds)


def stamp_of(header: Header) -> int:
    """Return the stamp of a header, ns."""
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)


def header(stamp_ns: int, frame: str) -> Header:
    """Return the header of a message."""
    return Header(stamp=time_message(stamp_ns), frame_id=frame)


def transform_message(
    stamp_ns: int, parent: str, child: str, parent_T_child: Transform3
) -> TransformStamped:
    """Return the pose of a child frame in its parent as a message."""
    (x, y, z), (qx, qy, qz, qw) = parent_T_child
    return TransformStamped(
        header=header(stamp_ns, parent),
        child_frame_id=child,
        transform=Transform(
            translation=Vector3(x=x, y=y, z=z),
            rotation=Quaternion(x=qx, y=qy, z=qz, w=qw),
        ),
    )
