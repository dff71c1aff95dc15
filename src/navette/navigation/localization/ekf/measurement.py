"""Measurements of some entries of the state, and their model."""

import math
from dataclasses import dataclass

import numpy as np

from navette.navigation.localization.ekf.state import SIZE, YAW, Array, X, Y, wrapped


@dataclass(frozen=True, eq=False)
class Measurement:
    """Measured values of some entries of the state.

    With a lever arm, x and y are those of that point of the robot.
    """

    source: str
    """name of the input"""
    stamp_ns: int
    indices: tuple[int, ...]
    """(n,) entries of the state, ascending"""
    values: Array
    """(n,)"""
    covariance: Array
    """(n, n)"""
    threshold: float = math.inf
    """largest Mahalanobis distance from the expected values"""
    lever: tuple[float, float] = (0.0, 0.0)
    """(x, y), m, in the base frame"""

    @property
    def is_position(self) -> bool:
        """Whether it measures x and y."""
        return self.indices[:2] == (X, Y)


def expected(measurement: Measurement, state: Array) -> Array:
    """Return the noise-free measurement (n,) in this state."""
    full = state.copy()
    lx, ly = measurement.lever
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    full[X] += c * lx - s * ly
    full[Y] += s * lx + c * ly
    seen: Array = full[list(measurement.indices)]
    return seen


def expected_jacobian(measurement: Measurement, state: Array) -> Array:
    """Return ∂expected / ∂state (n, 8)."""
    full = np.eye(SIZE)
    lx, ly = measurement.lever
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    full[X, YAW] = -s * lx - c * ly
    full[Y, YAW] = c * lx - s * ly
    seen: Array = full[list(measurement.indices)]
    return seen


def innovation(measurement: Measurement, state: Array) -> Array:
    """Return measured minus expected (n,), headings in [−π, π]."""
    difference = measurement.values - expected(measurement, state)
    if YAW in measurement.indices:
        at = measurement.indices.index(YAW)
        difference[at] = wrapped(difference[at])
    return difference
