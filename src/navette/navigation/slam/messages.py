"""Conversion of scans from sensor_msgs/LaserScan."""

import math

import numpy as np

from navette.errors import InvalidInputError
from navette.geometry import Pose2, Transform3, yaw_of
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.grids import (
    LEVEL,
    PlanarScan,
    Upward,
    beam_directions,
    is_floor,
)

# Angle from the horizontal up to which a scanner counts as planar.
_MOST_TILT_RAD = math.radians(15.0)


def planar_scan(
    msg: LaserScan, base_T_sensor: Transform3, upward: Upward = LEVEL
) -> tuple[PlanarScan, Pose2]:
    """Return a scan and the sensor's pose in the plane of the base.

    The beams of a scanner that is mounted upside down are mirrored. Echoes of the
    floor, which a tilted robot sees, become invalid.

    Raises:
        InvalidInputError: ranges or angles out of range, or a scanner that is not
            horizontal.
    """
    (x, y, z), rotation = base_T_sensor
    upright = 1.0 - 2.0 * (rotation[0] ** 2 + rotation[1] ** 2)
    if abs(upright) < math.cos(_MOST_TILT_RAD):
        tilt = math.degrees(math.acos(max(-1.0, min(1.0, abs(upright)))))
        raise InvalidInputError(
            "not_planar",
            f"frame {msg.header.frame_id!r} is tilted by {tilt:.0f} degrees; SLAM "
            f"needs a scanner within {math.degrees(_MOST_TILT_RAD):.0f} degrees of the "
            "horizontal",
        )
    side = math.copysign(1.0, upright)
    least, most = float(msg.range_min), float(msg.range_max)
    if not (math.isfinite(least) and 0.0 <= least < most):
        raise InvalidInputError(
            "out_of_range",
            f"range_min {least}, range_max {most}; expected 0 <= range_min < range_max",
        )
    if not (math.isfinite(msg.angle_min) and math.isfinite(msg.angle_increment)):
        raise InvalidInputError("out_of_range", "angle_min or angle_increment")
    scan = PlanarScan(
        np.array(msg.ranges, np.float32),
        side * msg.angle_min,
        side * msg.angle_increment,
        least,
        min(most, 1e6),
    )
    pose = Pose2(x, y, yaw_of(rotation))
    if upward != LEVEL:
        _drop_floor(scan, pose, z, upward)
    return scan, pose


def _drop_floor(
    scan: PlanarScan, base_T_sensor: Pose2, height_m: float, upward: Upward
) -> None:
    directions = beam_directions(scan.angle_min, scan.angle_increment, len(scan.ranges))
    with np.errstate(invalid="ignore", over="ignore"):
        points = base_T_sensor.apply(directions * scan.ranges[:, None])
        scan.ranges[is_floor(points, height_m, upward)] = np.nan
