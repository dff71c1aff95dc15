"""Transformation of stamped messages to another frame (tf2_geometry_msgs' functions).

With the transform ``a_T_b`` each function converts an object from frame b to frame a.
The arguments are not changed.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Transform3
from navette.geometry.se3 import Vector3 as Triple
from navette.geometry.se3 import rotate, rotation_matrix
from navette.msgs.geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    Polygon,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
    TransformStamped,
    Vector3,
    Vector3Stamped,
    Wrench,
    WrenchStamped,
)
from navette.runtime.tf.conversions import transform_from_msg
from navette.runtime.tf.registration import ConvertRegistration, TransformRegistration


def do_transform_point(
    point: PointStamped, transform: TransformStamped
) -> PointStamped:
    p = point.point
    x, y, z = transform_from_msg(transform.transform).apply((p.x, p.y, p.z))
    return PointStamped(header=transform.header, point=Point(x=x, y=y, z=z))


def do_transform_vector3(
    vector3: Vector3Stamped, transform: TransformStamped
) -> Vector3Stamped:
    """Return the vector in the transform's frame: rotated, not translated."""
    v = vector3.vector
    rotation = transform_from_msg(transform.transform).rotation
    x, y, z = rotate(rotation, (v.x, v.y, v.z))
    return Vector3Stamped(header=transform.header, vector=Vector3(x=x, y=y, z=z))


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """Return the pose in the transform's frame; the quaternion has w ≥ 0."""
    p, q = pose.position, pose.orientation
    inner = Transform3((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))
    (x, y, z), (qx, qy, qz, qw) = transform_from_msg(transform.transform) @ inner
    if qw < 0:
        qx, qy, qz, qw = -qx, -qy, -qz, -qw
    return Pose(
        position=Point(x=x, y=y, z=z),
        orientation=Quaternion(x=qx, y=qy, z=qz, w=qw),
    )


def do_transform_pose_stamped(
    pose: PoseStamped, transform: TransformStamped
) -> PoseStamped:
    return PoseStamped(
        header=transform.header, pose=do_transform_pose(pose.pose, transform)
    )


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    return PoseWithCovarianceStamped(
        header=transform.header,
        pose=PoseWithCovariance(
            pose=do_transform_pose(pose.pose.pose, transform),
            covariance=transform_covariance(pose.pose.covariance, transform),
        ),
    )


def do_transform_polygon_stamped(
    polygon: PolygonStamped, transform: TransformStamped
) -> PolygonStamped:
    a_T_b = transform_from_msg(transform.transform)
    corners = (a_T_b.apply((p.x, p.y, p.z)) for p in polygon.polygon.points)
    points = [Point32(x=x, y=y, z=z) for x, y, z in corners]
    return PolygonStamped(header=transform.header, polygon=Polygon(points=points))


def do_transform_wrench_stamped(
    wrench: WrenchStamped, transform: TransformStamped
) -> WrenchStamped:
    """Return force and torque about the origin of the transform's frame.

    torque_a = R·torque_b + t × (R·force_b): the force acts at b's origin.
    """
    a_T_b = transform_from_msg(transform.transform)
    force, torque = wrench.wrench.force, wrench.wrench.torque
    force_a = rotate(a_T_b.rotation, (force.x, force.y, force.z))
    rotated = rotate(a_T_b.rotation, (torque.x, torque.y, torque.z))
    lever = _cross(a_T_b.translation, force_a)
    return WrenchStamped(
        header=transform.header,
        wrench=Wrench(
            force=_vector(force_a),
            torque=_vector(
                (rotated[0] + lever[0], rotated[1] + lever[1], rotated[2] + lever[2])
            ),
        ),
    )


def transform_covariance(
    cov_in: NDArray[np.float64], transform: TransformStamped
) -> NDArray[np.float64]:
    """Return a pose's covariance in the transform's frame.

    Σ_a = diag(R, R) · Σ_b · diag(R, R)ᵀ, for (x, y, z, rotation about x, y, z).

    Args:
        cov_in: 36 values, row by row.

    Returns:
        36 values, row by row.
    """
    rotation = transform_from_msg(transform.transform).rotation
    blocks = np.zeros((6, 6))
    blocks[:3, :3] = blocks[3:, 3:] = rotation_matrix(rotation)
    covariance = np.asarray(cov_in, dtype=np.float64).reshape(6, 6)
    rotated: NDArray[np.float64] = (blocks @ covariance @ blocks.T).ravel()
    return rotated


def _cross(a: Triple, b: Triple) -> Triple:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def _vector(v: Triple) -> Vector3:
    return Vector3(x=v[0], y=v[1], z=v[2])


def from_msg_msg(msg: Any) -> Any:
    """Return the message unchanged."""
    return msg


to_msg_msg = from_msg_msg

_FUNCTIONS: dict[type, Callable[[Any, TransformStamped], Any]] = {
    PointStamped: do_transform_point,
    PolygonStamped: do_transform_polygon_stamped,
    PoseStamped: do_transform_pose_stamped,
    PoseWithCovarianceStamped: do_transform_pose_with_covariance_stamped,
    Vector3Stamped: do_transform_vector3,
    WrenchStamped: do_transform_wrench_stamped,
}
for _type, _function in _FUNCTIONS.items():
    TransformRegistration().add(_type, _function)
    ConvertRegistration().add_to_msg(_type, to_msg_msg)
    ConvertRegistration().add_from_msg(_type, from_msg_msg)
