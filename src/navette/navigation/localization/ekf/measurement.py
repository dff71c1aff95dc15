"""Measurements of some entries of the state, and their model."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.localization.ekf.state import SIZE, YAW, Array, X, Y, wrapped

Indices = NDArray[np.int64]


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
    def rows(self) -> Indices:
        """The entries as an array."""
        return np.array(self.indices, np.int64)

    @property
    def is_position(self) -> bool:
        """Whether it measures x and y."""
        return self.indices[:2] == (X, Y)


def expected(measurement: Measurement, state: Array) -> Array:
    """Return the noise-free measurement (n,) in this state."""
    return expected_of(measurement.rows, measurement.lever, state)


def expected_jacobian(measurement: Measurement, state: Array) -> Array:
    """Return ∂expected / ∂state (n, 8)."""
    return jacobian_of(measurement.rows, measurement.lever, state)


def innovation(measurement: Measurement, state: Array) -> Array:
    """Return measured minus expected (n,), headings in [−π, π]."""
    return residual(measurement.rows, measurement.values, measurement.lever, state)


@kernel
def expected_of(rows: Indices, lever: tuple[float, float], state: Array) -> Array:
    """Return :func:`expected` of a measurement's rows and lever."""
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    seen = np.empty(rows.size)
    for i in range(rows.size):
        seen[i] = state[rows[i]]
        if rows[i] == X:
            seen[i] += c * lever[0] - s * lever[1]
        elif rows[i] == Y:
            seen[i] += s * lever[0] + c * lever[1]
    return seen


@kernel
def jacobian_of(rows: Indices, lever: tuple[float, float], state: Array) -> Array:
    """Return :func:`expected_jacobian` of a measurement's rows and lever."""
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    jacobian = np.zeros((rows.size, SIZE))
    for i in range(rows.size):
        jacobian[i, rows[i]] = 1.0
        if rows[i] == X:
            jacobian[i, YAW] = -s * lever[0] - c * lever[1]
        elif rows[i] == Y:
            jacobian[i, YAW] = c * lever[0] - s * lever[1]
    return jacobian


@kernel
def residual(
    rows: Indices, values: Array, lever: tuple[float, float], state: Array
) -> Array:
    """Return :func:`innovation` of a measurement's rows, values and lever."""
    difference = expected_of(rows, lever, state)
    for i in range(rows.size):
        difference[i] = values[i] - difference[i]
        if rows[i] == YAW:
            difference[i] = wrapped(difference[i])
    return difference
