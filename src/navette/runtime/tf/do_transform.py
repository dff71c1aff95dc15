"""Move stamped messages to another frame (tf2_geometry_msgs' functions)."""

from collections.abc import Callable
from typing import Any

from navette.errors import InvalidValueError
from navette.geometry import Transform3
from navette.geometry.se3 import rotate
from navette.msgs.geometry_msgs.msg import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    Quaternion,
    TransformStamped,
    Vector3,
    Vector3Stamped,
)
from navette.runtime.tf.conversions import transform_from_msg


def do_transform_point(
    point: PointStamped, transform: TransformStamped
) -> PointStamped:
    """The same point, in the transform's frame."""
    p = point.point
    x, y, z = transform_from_msg(transform.transform).apply((p.x, p.y, p.z))
    return PointStamped(header=transform.header, point=Point(x=x, y=y, z=z))


def do_transform_vector3(
    vector3: Vector3Stamped, transform: TransformStamped
) -> Vector3Stamped:
    """The same direction, in the transform's frame: turned, not moved."""
    v = vector3.vector
    rotation = transform_from_msg(transform.transform).rotation
    x, y, z = rotate(rotation, (v.x, v.y, v.z))
    return Vector3Stamped(header=transform.header, vector=Vector3(x=x, y=y, z=z))


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """The same pose, in the transform's frame."""
    p, q = pose.position, pose.orientation
    inner = Transform3((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))
    (x, y, z), (qx, qy, qz, qw) = transform_from_msg(transform.transform) @ inner
    return Pose(
        position=Point(x=x, y=y, z=z),
        orientation=Quaternion(x=qx, y=qy, z=qz, w=qw),
    )


def do_transform_pose_stamped(
    pose: PoseStamped, transform: TransformStamped
) -> PoseStamped:
    """The same pose, in the transform's frame."""
    return PoseStamped(
        header=transform.header, pose=do_transform_pose(pose.pose, transform)
    )


_KNOWN: dict[type, Callable[[Any, TransformStamped], Any]] = {
    PointStamped: do_transform_point,
    PoseStamped: do_transform_pose_stamped,
    Vector3Stamped: do_transform_vector3,
}


def do_transform(stamped: Any, transform: TransformStamped) -> Any:
    """A PointStamped, PoseStamped or Vector3Stamped in the transform's frame.

    Raises:
        InvalidValueError: of another type.
    """
    function = _KNOWN.get(type(stamped))
    if function is None:
        known = ", ".join(kind.__name__ for kind in _KNOWN)
        raise InvalidValueError(
            f"cannot transform a {type(stamped).__name__}; known: {known}"
        )
    return function(stamped, transform)
