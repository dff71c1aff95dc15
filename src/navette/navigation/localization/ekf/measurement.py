"""What a sensor says about some entries of the state."""

import math
from dataclasses import dataclass

import numpy as np

from navette.navigation.localization.ekf.state import SIZE, YAW, Array, X, Y, wrapped


@dataclass(frozen=True, eq=False)
class Measurement:
    """Some of the state's entries as a sensor saw them.

    Where a lever arm is given, x and y are those of that point of the robot.
    """

    source: str
    """the sensor's name; its stamps come in order"""
    stamp_ns: int
    indices: tuple[int, ...]
    """(n,) entries of the state, ascending"""
    values: Array
    """(n,)"""
    covariance: Array
    """(n, n)"""
    threshold: float = math.inf
    """largest Mahalanobis distance from what is expected"""
    lever: tuple[float, float] = (0.0, 0.0)
    """(x, y), m, in the base frame"""


def expected(measurement: Measurement, state: Array) -> Array:
    """(n,) what the sensor would say in this state, without noise."""
    full = state.copy()
    lx, ly = measurement.lever
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    full[X] += c * lx - s * ly
    full[Y] += s * lx + c * ly
    seen: Array = full[list(measurement.indices)]
    return seen


def expected_jacobian(measurement: Measurement, state: Array) -> Array:
    """(n, 8) ∂expected / ∂state."""
    full = np.eye(SIZE)
    lx, ly = measurement.lever
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    full[X, YAW] = -s * lx - c * ly
    full[Y, YAW] = c * lx - s * ly
    seen: Array = full[list(measurement.indices)]
    return seen


def innovation(measurement: Measurement, state: Array) -> Array:
    """(n,) measured minus expected, headings the short way round."""
    difference = measurement.values - expected(measurement, state)
    if YAW in measurement.indices:
        at = measurement.indices.index(YAW)
        difference[at] = wrapped(difference[at])
    return difference
