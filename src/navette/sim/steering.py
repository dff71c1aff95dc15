# SPDX-License-Identifier: Apache-2.0
"""Ackermann steering: angles of the wheels, and where that moves them."""

import math
from typing import NamedTuple

from navette.geometry import Pose2, Transform3, quaternion_from_yaw
from navette.sim.scene import AckermannDrive, Link, Model


class SteeringAngles(NamedTuple):
    """Angles (rad, left positive) of the steering joints."""

    left: float
    right: float


def steering_angles(drive: AckermannDrive, steering: float) -> SteeringAngles:
    """Return the angles at which both wheels turn about the same centre."""
    curvature = drive.curvature_of(steering)
    half = drive.kingpin_width / 2

    def angle(side: float) -> float:
        return math.atan2(drive.wheel_base * curvature, 1.0 - side * half * curvature)

    return SteeringAngles(angle(1.0), angle(-1.0))


def link_poses(model: Model, link: Link) -> list[Transform3]:
    """Return ``model_T_link`` ahead, and at both ends of the steering if it turns."""
    poses = [link.model_T_link]
    if not isinstance(model.drive, AckermannDrive):
        return poses
    above = {link.name} | {j.parent for j in model.joints if j.child == link.name}
    limit = model.drive.steering_limit
    ends = [steering_angles(model.drive, angle) for angle in (-limit, limit)]
    for side, name in enumerate(
        (model.drive.left_steering, model.drive.right_steering)
    ):
        joint = model.joint(name)
        if joint.child not in above:
            continue
        x, y, z = joint.model_T_joint.translation
        for end in ends:
            turned = Transform3((x, y, z), quaternion_from_yaw(end[side]))
            ahead = Transform3.from_pose2(Pose2(x, y, 0.0), z)
            poses.append(turned @ ahead.inverse() @ link.model_T_link)
    return poses
