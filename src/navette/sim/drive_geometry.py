# SPDX-License-Identifier: Apache-2.0
"""The base frame of a robot: on the floor, midway between its drive wheels."""

import math
from dataclasses import dataclass

from navette.errors import InvalidValueError
from navette.geometry import Transform3, Vector3, quaternion_from_yaw
from navette.geometry.se3 import rotate
from navette.sim.scene import AckermannDrive, MecanumDrive, Model


@dataclass(frozen=True)
class DriveWheel:
    """A driven wheel; ``direction`` ±1 is the joint's sign of rolling forward.

    ``slide`` is that of a mecanum wheel: its rim slows down by ``slide`` times the
    speed of the base to the left; 0 for other wheels.
    """

    joint: str
    link: str
    side: int  # +1 left, −1 right
    direction: float
    slide: float = 0.0


def drive_wheels(model: Model) -> tuple[DriveWheel, ...]:
    """Return the driven wheels of a model, left ones first.

    Raises:
        InvalidValueError: the drive names a joint that the model does not have.
    """
    assert model.drive is not None, "drive_wheels() of a model without a drive"
    left_axis_model = _left_of(model)
    wheels = []
    slides = isinstance(model.drive, MecanumDrive)
    for side, names in ((1, model.drive.left_joints), (-1, model.drive.right_joints)):
        for index, name in enumerate(names):
            joint = model.joint(name)
            axis_model = rotate(joint.model_T_joint.rotation, joint.axis)
            along = sum(a * b for a, b in zip(axis_model, left_axis_model, strict=True))
            direction = math.copysign(1.0, along)
            # The rollers of front left and back right point forward and right.
            slide = (side if index == 0 else -side) if slides else 0.0
            wheels.append(DriveWheel(name, joint.child, side, direction, slide))
    return tuple(wheels)


def rolling_links(model: Model) -> set[str]:
    """Return the links of all wheels: driven ones and those on steered links."""
    links = {wheel.link for wheel in drive_wheels(model)}
    if isinstance(model.drive, AckermannDrive):
        names = model.drive.left_steering, model.drive.right_steering
        steered = {model.joint(name).child for name in names}
        links |= {j.child for j in model.joints if j.parent in steered}
    return links


def base_of(model: Model) -> Transform3:
    """``model_T_base``: axle midpoint on the floor, x forward, z up."""
    assert model.drive is not None, "base_of() of a model without a drive"
    left, right = _sides(model)
    x, y, z = ((a + b) / 2 for a, b in zip(left, right, strict=True))
    to_left = _left_of(model)
    yaw = math.atan2(-to_left[0], to_left[1])
    # Tiny angles come from files that write pi with five digits.
    yaw = 0.0 if abs(yaw) < 1e-3 else yaw
    floor = z - model.drive.wheel_radius
    return Transform3((x, y, floor), quaternion_from_yaw(yaw))


def _sides(model: Model) -> tuple[Vector3, Vector3]:
    """Mean position (model frame) of the left and of the right wheel joints."""
    assert model.drive is not None
    means = []
    for names in (model.drive.left_joints, model.drive.right_joints):
        points = [model.joint(name).model_T_joint.translation for name in names]
        x, y, z = (sum(axis) / len(points) for axis in zip(*points, strict=True))
        means.append((x, y, z))
    return means[0], means[1]


def _left_of(model: Model) -> Vector3:
    """Unit vector (model frame, level) from the right wheels to the left ones."""
    left, right = _sides(model)
    dx, dy = left[0] - right[0], left[1] - right[1]
    length = math.hypot(dx, dy)
    if length < 1e-6:
        raise InvalidValueError(
            f"model {model.name!r}: left and right wheels are at the same place"
        )
    return (dx / length, dy / length, 0.0)
