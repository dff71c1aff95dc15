"""Rigid transforms in space: SE(3), quaternions in ROS order (x, y, z, w)."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry.se2 import Pose2

Quaternion = tuple[float, float, float, float]
Vector3 = tuple[float, float, float]

_AXES: tuple[Vector3, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def quaternion_from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """Rotation about fixed x, then y, then z (radians), as in SDF, URDF, REP 103."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def quaternion_from_yaw(yaw: float) -> Quaternion:
    """Rotation about z by ``yaw`` radians."""
    return (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def yaw_of(q: Quaternion) -> float:
    """Heading (rad) of the rotated x axis in the xy plane."""
    x, y, z, w = q
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """Hamilton product: the rotation ``b`` followed by ``a``."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def rotate(q: Quaternion, v: Vector3) -> Vector3:
    """Rotate the vector ``v`` by the unit quaternion ``q``."""
    x, y, z, w = q
    vx, vy, vz = v
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )


def rotation_matrix(q: Quaternion) -> NDArray[np.float64]:
    """Rotation matrix, shape (3, 3), of the unit quaternion ``q``."""
    return np.array([rotate(q, axis) for axis in _AXES]).T


def slerp(a: Quaternion, b: Quaternion, fraction: float) -> Quaternion:
    """Spherical interpolation along the shorter arc (Shoemake 1985)."""
    dot = sum(p * q for p, q in zip(a, b, strict=True))
    sign = -1.0 if dot < 0 else 1.0
    dot = min(abs(dot), 1.0)
    angle = math.acos(dot)
    if angle < 1e-6:
        wa, wb = 1 - fraction, sign * fraction
    else:
        wa = math.sin((1 - fraction) * angle) / math.sin(angle)
        wb = sign * math.sin(fraction * angle) / math.sin(angle)
    x, y, z, w = (wa * p + wb * q for p, q in zip(a, b, strict=True))
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    return (x / norm, y / norm, z / norm, w / norm)


class Transform3(NamedTuple):
    """``outer_T_inner``: translation (m) and unit quaternion (x, y, z, w)."""

    translation: Vector3
    rotation: Quaternion

    @classmethod
    def identity(cls) -> "Transform3":
        return cls((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))

    @classmethod
    def from_pose2(cls, pose: Pose2, z: float = 0.0) -> "Transform3":
        return cls((pose.x, pose.y, z), quaternion_from_yaw(pose.yaw))

    def to_pose2(self) -> Pose2:
        """Projection to the plane: x, y and heading."""
        return Pose2(self.translation[0], self.translation[1], yaw_of(self.rotation))

    def apply(self, p: Vector3) -> Vector3:
        """Transform a point (m) from the inner to the outer frame."""
        x, y, z = rotate(self.rotation, p)
        tx, ty, tz = self.translation
        return (x + tx, y + ty, z + tz)

    def __matmul__(self, other: "Transform3") -> "Transform3":
        (tx, ty, tz), rotation = self
        (x, y, z), turn = other
        x, y, z = rotate(rotation, (x, y, z))
        return Transform3((x + tx, y + ty, z + tz), multiply(rotation, turn))

    def inverse(self) -> "Transform3":
        x, y, z, w = self.rotation
        inverse: Quaternion = (-x, -y, -z, w)
        tx, ty, tz = rotate(inverse, self.translation)
        return Transform3((-tx, -ty, -tz), inverse)

    def interpolate(self, other: "Transform3", fraction: float) -> "Transform3":
        """Interpolate between ``self`` (0) and ``other`` (1): straight line, slerp."""
        a, b = self.translation, other.translation
        x, y, z = (p + fraction * (q - p) for p, q in zip(a, b, strict=True))
        return Transform3((x, y, z), slerp(self.rotation, other.rotation, fraction))
