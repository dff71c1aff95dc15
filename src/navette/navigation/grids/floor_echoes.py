"""Echoes of the floor, which a tilted planar scanner sees as a wall.

A robot that brakes or turns hard tilts by a few degrees: a scanner 0.3 m above the
floor then meets it 5 m away.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

# Of the scanner's height; echoes below it count as floor. The rest is the error of the
# tilt at the longest ranges.
_LOWEST = 0.4


class Upward(NamedTuple):
    """Unit vector against gravity, in the base frame; (0, 0, 1) on level ground."""

    x: float
    y: float
    z: float


LEVEL = Upward(0.0, 0.0, 1.0)


def upward_of(rotation: tuple[float, float, float, float]) -> Upward:
    """Return the upward vector of a base with this orientation (x, y, z, w)."""
    x, y, z, w = rotation
    return Upward(
        2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
    )


def is_floor(
    points: NDArray[np.float64], height_m: float, upward: Upward
) -> NDArray[np.bool_]:
    """Return (N,) whether echoes are of the floor that the base stands on.

    Args:
        points: (N, 2) in the base frame, m.
        height_m: of the scanner in the base frame.
        upward: attitude of the base.
    """
    if upward == LEVEL or height_m <= 0.0:
        return np.zeros(len(points), np.bool_)
    height = upward.x * points[:, 0] + upward.y * points[:, 1] + upward.z * height_m
    low: NDArray[np.bool_] = height < _LOWEST * height_m
    return low
