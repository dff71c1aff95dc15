"""Euler angles for any of the 24 sequences of axes.

``axes`` is ``s`` (static axes) or ``r`` (rotating axes) and three axes in the order of
the rotations: ``sxyz`` is roll, pitch, yaw. A sequence of rotating axes equals the
reversed sequence of static axes (K. Shoemake, "Euler angle conversion", Graphics Gems
IV, 1994), so that only one case is computed.
"""

import math
import re

import numpy as np
from numpy.typing import ArrayLike

from navette.errors import InvalidValueError
from navette.geometry.se3 import Quaternion, multiply
from navette.ros2.packages.tf_transformations.matrices import quaternion_matrix
from navette.ros2.packages.tf_transformations.quaternions import Array

_AXES = re.compile(r"([sr])([xyz])(?!\2)([xyz])(?!\3)([xyz])")
_EPSILON = 4 * np.finfo(np.float64).eps


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    """Convert angles (rad) to a quaternion (x, y, z, w)."""
    rotating, order = _parsed(axes)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)
    for index, angle in zip(order, (ai, aj, ak), strict=True):
        part = [0.0, 0.0, 0.0, math.cos(angle / 2)]
        part[index] = math.sin(angle / 2)
        step: Quaternion = (part[0], part[1], part[2], part[3])
        rotation = multiply(rotation, step) if rotating else multiply(step, rotation)
    return np.array(rotation)


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    """Convert angles (rad) to a 4 × 4 matrix."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_quaternion(
    quaternion: ArrayLike, axes: str = "sxyz"
) -> tuple[float, float, float]:
    """Convert a quaternion (x, y, z, w) to angles (rad)."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def euler_from_matrix(
    matrix: ArrayLike, axes: str = "sxyz"
) -> tuple[float, float, float]:
    """Convert a 3 × 3 or 4 × 4 rotation matrix to angles (rad).

    In gimbal lock the angle about the last static axis is 0.
    """
    rotating, order = _parsed(axes)
    R = np.asarray(matrix, dtype=np.float64)[:3, :3]
    first, second, third = order[::-1] if rotating else order
    if first == third:
        angles = _proper(R, first, second)
    else:
        angles = _three_axes(R, first, second, third)
    return angles[::-1] if rotating else angles


def _three_axes(R: Array, i: int, j: int, k: int) -> tuple[float, float, float]:
    """Return a, b, c of R = R_k(c) R_j(b) R_i(a)."""
    sign = _parity(i, j)
    cosine = math.hypot(R[i, i], R[j, i])
    b = math.atan2(-sign * R[k, i], cosine)
    if cosine <= _EPSILON:
        return math.atan2(-sign * R[j, k], R[j, j]), b, 0.0
    return math.atan2(sign * R[k, j], R[k, k]), b, math.atan2(sign * R[j, i], R[i, i])


def _proper(R: Array, i: int, j: int) -> tuple[float, float, float]:
    """Return a, b, c of R = R_i(c) R_j(b) R_i(a)."""
    sign, m = _parity(i, j), 3 - i - j
    sine = math.hypot(R[i, j], R[i, m])
    b = math.atan2(sine, R[i, i])
    if sine <= _EPSILON:
        return math.atan2(-sign * R[j, m], R[j, j]), b, 0.0
    return (
        math.atan2(R[i, j], sign * R[i, m]),
        b,
        math.atan2(R[j, i], -sign * R[m, i]),
    )


def _parity(i: int, j: int) -> int:
    """Return 1 if j follows i in x, y, z, x, …; else −1."""
    return 1 if (j - i) % 3 == 1 else -1


def _parsed(axes: str) -> tuple[bool, tuple[int, int, int]]:
    """Return whether the axes rotate, and their indices."""
    match = _AXES.fullmatch(axes)
    if match is None:
        raise InvalidValueError(
            f"axes {axes!r}: expected s or r and three of x, y, z without equal "
            "neighbours, as in 'sxyz'"
        )
    first, second, third = ("xyz".index(axis) for axis in match.groups()[1:])
    return match[1] == "r", (first, second, third)
