"""Quaternions as arrays (x, y, z, w)."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from navette.errors import InvalidValueError
from navette.geometry.se3 import Quaternion, multiply, slerp

Array = NDArray[np.float64]


def as_quaternion(values: ArrayLike) -> Quaternion:
    """Return four numbers as a tuple.

    Raises:
        InvalidValueError: there are not four numbers.
    """
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (4,):
        raise InvalidValueError(f"quaternion {values!r}: expected (x, y, z, w)")
    x, y, z, w = array.tolist()
    return (x, y, z, w)


def unit(values: ArrayLike) -> Quaternion:
    """Return the normalised quaternion.

    Raises:
        InvalidValueError: there are not four numbers, or all are zero.
    """
    x, y, z, w = as_quaternion(values)
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    if not norm > 0:
        raise InvalidValueError(f"quaternion {values!r} is not a rotation")
    return (x / norm, y / norm, z / norm, w / norm)


def quaternion_multiply(quaternion1: ArrayLike, quaternion0: ArrayLike) -> Array:
    """Return the rotation ``quaternion0`` followed by ``quaternion1``."""
    return np.array(multiply(as_quaternion(quaternion1), as_quaternion(quaternion0)))


def quaternion_conjugate(quaternion: ArrayLike) -> Array:
    """Return (−x, −y, −z, w), the inverse of a unit quaternion."""
    x, y, z, w = as_quaternion(quaternion)
    return np.array([-x, -y, -z, w])


def quaternion_inverse(quaternion: ArrayLike) -> Array:
    """Return the multiplicative inverse."""
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
    return np.array(slerp(unit(quat0), unit(quat1), fraction))
