"""tf_transformations: Euler angles, quaternions (x, y, z, w) and 4 × 4 matrices.

Angles are in rad. The argument ``axes`` is ``s`` (static axes) or ``r`` (rotating axes)
and three axes in the order of the rotations: ``sxyz`` is roll, pitch, yaw. A sequence
of rotating axes equals the reversed sequence of static axes (K. Shoemake, "Euler angle
conversion", Graphics Gems IV, 1994), so that only one case is computed.

An argument that is not a rotation or a direction raises InvalidValueError.
"""

import functools
import math
import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from navette.errors import InvalidValueError
from navette.geometry.se3 import Quaternion, multiply, rotation_matrix, slerp

__all__ = [
    "concatenate_matrices",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "translation_from_matrix",
    "translation_matrix",
]

Array = NDArray[np.float64]

_AXES = re.compile(r"([sr])([xyz])(?!\2)([xyz])(?!\3)([xyz])")
_EPSILON = 4 * np.finfo(np.float64).eps


def quaternion_multiply(quaternion1: ArrayLike, quaternion0: ArrayLike) -> Array:
    """Return the rotation ``quaternion0`` followed by ``quaternion1``."""
    return np.array(multiply(_as_tuple(quaternion1), _as_tuple(quaternion0)))


def quaternion_conjugate(quaternion: ArrayLike) -> Array:
    """Return (−x, −y, −z, w), the inverse of a unit quaternion."""
    x, y, z, w = _as_tuple(quaternion)
    return np.array([-x, -y, -z, w])


def quaternion_inverse(quaternion: ArrayLike) -> Array:
    conjugate = quaternion_conjugate(quaternion)
    return conjugate / np.dot(conjugate, conjugate)  # type: ignore[no-any-return]


def quaternion_about_axis(angle: float, axis: Sequence[float]) -> Array:
    """Return the rotation by ``angle`` (rad) about ``axis`` of any length but 0."""
    direction = np.asarray(axis, dtype=np.float64)[:3]
    length = float(np.linalg.norm(direction))
    if not length > 0:
        raise InvalidValueError(f"axis {axis!r} has no direction")
    xyz = direction * (math.sin(angle / 2) / length)
    return np.array([*xyz, math.cos(angle / 2)])


def quaternion_slerp(quat0: ArrayLike, quat1: ArrayLike, fraction: float) -> Array:
    """Interpolate between two rotations along the shorter arc."""
    return np.array(slerp(_unit(quat0), _unit(quat1), fraction))


def identity_matrix() -> Array:
    return np.eye(4)


def translation_matrix(direction: Sequence[float]) -> Array:
    matrix = np.eye(4)
    matrix[:3, 3] = direction[:3]
    return matrix


def translation_from_matrix(matrix: ArrayLike) -> Array:
    return np.array(matrix, dtype=np.float64)[:3, 3].copy()


def quaternion_matrix(quaternion: ArrayLike) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_matrix(_unit(quaternion))
    return matrix


def quaternion_from_matrix(matrix: ArrayLike) -> Array:
    """Return the quaternion (w ≥ 0) of a 3 × 3 or 4 × 4 rotation matrix.

    It is the eigenvector of the largest eigenvalue of Bar-Itzhack's K, which tolerates
    rounding errors in the matrix (Bar-Itzhack 2000, eq. 10).
    """
    R = np.asarray(matrix, dtype=np.float64)[:3, :3]
    K = np.zeros((4, 4))
    K[:3, :3] = R + R.T - np.trace(R) * np.eye(3)
    K[3, :3] = K[:3, 3] = (R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1])
    K[3, 3] = np.trace(R)
    quaternion: Array = np.linalg.eigh(K)[1][:, -1]
    return -quaternion if quaternion[3] < 0 else quaternion


def concatenate_matrices(*matrices: ArrayLike) -> Array:
    """Return the product of the matrices; the last one acts first."""
    return functools.reduce(np.matmul, map(np.asarray, matrices), np.eye(4))


def inverse_matrix(matrix: ArrayLike) -> Array:
    return np.linalg.inv(np.asarray(matrix, dtype=np.float64))


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    rotating, order = _parsed(axes)
    rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)
    for index, angle in zip(order, (ai, aj, ak), strict=True):
        part = [0.0, 0.0, 0.0, math.cos(angle / 2)]
        part[index] = math.sin(angle / 2)
        step: Quaternion = (part[0], part[1], part[2], part[3])
        rotation = multiply(rotation, step) if rotating else multiply(step, rotation)
    return np.array(rotation)


def euler_matrix(ai: float, aj: float, ak: float, axes: str = "sxyz") -> Array:
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_quaternion(
    quaternion: ArrayLike, axes: str = "sxyz"
) -> tuple[float, float, float]:
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


def _as_tuple(values: ArrayLike) -> Quaternion:
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (4,):
        raise InvalidValueError(f"quaternion {values!r}: expected (x, y, z, w)")
    x, y, z, w = array.tolist()
    return (x, y, z, w)


def _unit(values: ArrayLike) -> Quaternion:
    x, y, z, w = _as_tuple(values)
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    if not norm > 0:
        raise InvalidValueError(f"quaternion {values!r} is not a rotation")
    return (x / norm, y / norm, z / norm, w / norm)
