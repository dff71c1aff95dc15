"""Conversion of scans to points, and of particles to messages."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidInputError
from navette.geometry import Pose2, quaternion_from_yaw
from navette.msgs.geometry_msgs.msg import Point, Pose, Quaternion
from navette.msgs.nav2_msgs.msg import Particle, ParticleCloud
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import Header
from navette.navigation.localization.amcl.params import AmclParams

_PLANAR = np.ix_([0, 1, 5], [0, 1, 5])


def scan_points(
    msg: LaserScan, base_T_sensor: Pose2, params: AmclParams
) -> NDArray[np.float64]:
    """Return where beams ended (N, 2), base frame, m; beams without echo are left out.

    Raises:
        InvalidInputError: the angles are not finite.
    """
    if not (math.isfinite(msg.angle_min) and math.isfinite(msg.angle_increment)):
        raise InvalidInputError("not_finite", "angle_min or angle_increment")
    with np.errstate(invalid="ignore"):  # signalling NaNs
        ranges = np.asarray(msg.ranges, np.float64)
    least = msg.range_min if params.laser_min_range < 0 else params.laser_min_range
    most = msg.range_max
    if params.laser_max_range >= 0:
        most = min(most, params.laser_max_range)
    used = np.flatnonzero((ranges > least) & (ranges < most))
    angles = msg.angle_min + msg.angle_increment * used
    along = ranges[used]
    points = np.column_stack([along * np.cos(angles), along * np.sin(angles)])
    return base_T_sensor.apply(points)


def planar_covariance(covariance: object) -> NDArray[np.float64]:
    """Return the covariance (3, 3) of x, y, yaw of that (36,) of a pose."""
    return np.asarray(covariance, np.float64).reshape(6, 6)[_PLANAR].copy()


def spatial_covariance(covariance: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the covariance (36,) of a pose of that (3, 3) of x, y, yaw."""
    spatial = np.zeros((6, 6))
    spatial[_PLANAR] = covariance
    return spatial.ravel()


def cloud_message(
    particles: NDArray[np.float64], weights: NDArray[np.float64], header: Header
) -> ParticleCloud:
    """Return particles (N, 3) x, y, yaw with their weights (N,)."""
    found = []
    for (x, y, yaw), weight in zip(particles.tolist(), weights.tolist(), strict=True):
        qx, qy, qz, qw = quaternion_from_yaw(yaw)
        pose = Pose(
            position=Point(x=x, y=y), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw)
        )
        found.append(Particle(pose=pose, weight=weight))
    return ParticleCloud(header=header, particles=found)
