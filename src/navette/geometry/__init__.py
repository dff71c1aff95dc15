"""Angles, poses, transforms and footprints."""

from navette.geometry.covariance import largest_stddev
from navette.geometry.drives import ACKERMANN, DIFFERENTIAL, DRIVES, OMNI
from navette.geometry.footprint import Footprint
from navette.geometry.se2 import (
    Pose2,
    advanced,
    angle_difference,
    wrap_angle,
    wrap_angles,
)
from navette.geometry.se3 import (
    Quaternion,
    Transform3,
    Vector3,
    quaternion_from_rpy,
    quaternion_from_yaw,
    yaw_of,
)

__all__ = [
    "Pose2",
    "Transform3",
    "Quaternion",
    "Vector3",
    "quaternion_from_rpy",
    "quaternion_from_yaw",
    "yaw_of",
    "advanced",
    "angle_difference",
    "wrap_angle",
    "wrap_angles",
    "largest_stddev",
    "Footprint",
    "DRIVES",
    "DIFFERENTIAL",
    "ACKERMANN",
    "OMNI",
]
