"""Conversion of the estimate to messages."""

import numpy as np

from navette.geometry import (
    Pose2,
    Transform3,
    quaternion_from_yaw,
    yaw_of,
)
from navette.geometry.messages import header
from navette.geometry.se3 import Quaternion as Rotation
from navette.geometry.se3 import multiply
from navette.msgs.geometry_msgs.msg import (
    Point,
    Pose,
    PoseWithCovariance,
    Quaternion,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.localization.ekf.filter import Estimate
from navette.navigation.localization.ekf.state import VX, VY, VYAW, YAW, Array, X

PLANAR_POSE = np.ix_([0, 1, 5], [0, 1, 5])


def transform_of(estimate: Estimate, attitude: Rotation) -> Transform3:
    """Return world_T_base: position and heading of the estimate, measured tilt."""
    x, y, yaw = pose_of(estimate)
    turn = quaternion_from_yaw(yaw - yaw_of(attitude))
    return Transform3((x, y, 0.0), multiply(turn, attitude))


def odometry_message(
    estimate: Estimate, world: str, base: str, attitude: Rotation
) -> Odometry:
    """Return pose in the world frame and velocity along the base's axes.

    Args:
        attitude: measured orientation of the base, for roll and pitch. Their variances,
            and that of the height, are 0.
    """
    state = estimate.state
    (x, y, _), (qx, qy, qz, qw) = transform_of(estimate, attitude)
    return Odometry(
        header=header(estimate.stamp_ns, world),
        child_frame_id=base,
        pose=PoseWithCovariance(
            pose=Pose(
                position=Point(x=x, y=y),
                orientation=Quaternion(x=qx, y=qy, z=qz, w=qw),
            ),
            covariance=_spatial(estimate.covariance, X),
        ),
        twist=TwistWithCovariance(
            twist=Twist(
                linear=Vector3(x=float(state[VX]), y=float(state[VY])),
                angular=Vector3(z=float(state[VYAW])),
            ),
            covariance=_spatial(estimate.covariance, VX),
        ),
    )


def pose_of(estimate: Estimate) -> Pose2:
    """Return world_T_base."""
    x, y, yaw = estimate.state[X : YAW + 1].tolist()
    return Pose2(x, y, yaw)


def _spatial(covariance: Array, first: int) -> Array:
    """Return the covariance (36,) of a spatial pose or twist from three entries."""
    spatial = np.zeros((6, 6))
    spatial[PLANAR_POSE] = covariance[first : first + 3, first : first + 3]
    return spatial.ravel()
