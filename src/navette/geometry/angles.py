"""Angles in radians on the circle."""

import math


def wrap_angle(angle: float) -> float:
    """The same angle in (−π, π]."""
    wrapped = math.remainder(angle, math.tau)
    return math.pi if wrapped == -math.pi else wrapped


def angle_difference(a: float, b: float) -> float:
    """``a − b``, the short way round, in (−π, π]."""
    return wrap_angle(a - b)
