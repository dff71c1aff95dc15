"""Conversion of the estimate to messages."""

import numpy as np

from navette.geometry import Pose2, quaternion_from_yaw
from navette.geometry.messages import header
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
from navette.navigation.localization.ekf.state import VX, VY, VYAW, YAW, Array, X, Y

PLANAR_POSE = np.ix_([0, 1, 5], [0, 1, 5])


def odometry_message(estimate: Estimate, world: str, base: str) -> Odometry:
    """Return pose in the world frame and velocity along the base's axes.

    The variances of height, roll and pitch are 0: the robot is assumed to stay level.
    """
    state = estimate.state
    qx, qy, qz, qw = quaternion_from_yaw(state[YAW])
    return Odometry(
        header=header(estimate.stamp_ns, world),
        child_frame_id=base,
        pose=PoseWithCovariance(
            pose=Pose(
                position=Point(x=float(state[X]), y=float(state[Y])),
                orientation=Quaternion(x=qx, y=qy, z=qz, w=qw),
            ),
            covariance=_spatial(estimate.covariance, [X, Y, YAW]),
        ),
        twist=TwistWithCovariance(
            twist=Twist(
                linear=Vector3(x=float(state[VX]), y=float(state[VY])),
                angular=Vector3(z=float(state[VYAW])),
            ),
            covariance=_spatial(estimate.covariance, [VX, VY, VYAW]),
        ),
    )


def pose_of(estimate: Estimate) -> Pose2:
    """Return world_T_base."""
    x, y, yaw = estimate.state[[X, Y, YAW]].tolist()
    return Pose2(x, y, yaw)


def _spatial(covariance: Array, rows: list[int]) -> Array:
    """Return the covariance (36,) of a spatial pose or twist from three entries."""
    spatial = np.zeros((6, 6))
    spatial[PLANAR_POSE] = covariance[np.ix_(rows, rows)]
    return spatial.ravel()
