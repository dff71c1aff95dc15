"""State of a robot in the plane, and its motion model.

State (8,): x, y (m) and yaw (rad) of the base in the world frame; vx, vy (m/s), vyaw
(rad/s), ax, ay (m/s²) of the base along its own axes.
"""

import math

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError

Array = NDArray[np.float64]

NAMES = ("x", "y", "yaw", "vx", "vy", "vyaw", "ax", "ay")
X, Y, YAW, VX, VY, VYAW, AX, AY = range(8)
SIZE = 8

#: The order of robot_localization's lists of 15.
SPATIAL = tuple("x y z roll pitch yaw vx vy vz vroll vpitch vyaw ax ay az".split())
#: Indices of the state's entries in that order.
PLANAR = [SPATIAL.index(name) for name in NAMES]


def planar_covariance(values: tuple[float, ...], name: str) -> Array:
    """Return (8, 8) from 15 variances or a 15 × 15 matrix, row by row.

    Raises:
        InvalidValueError: wrong length, not symmetric, or not positive semidefinite.
    """
    spatial = len(SPATIAL)
    if len(values) not in (spatial, spatial**2):
        raise InvalidValueError(
            f"{name}: {len(values)} numbers; expected {spatial} variances or all "
            f"{spatial**2} entries, for {', '.join(SPATIAL)}"
        )
    array = np.array(values, dtype=np.float64)
    full = np.diag(array) if array.size == spatial else array.reshape(spatial, spatial)
    planar: Array = full[np.ix_(PLANAR, PLANAR)]
    if not is_covariance(planar):
        raise InvalidValueError(
            f"{name}: expected a symmetric matrix without negative eigenvalues"
        )
    return planar


_LARGEST_VARIANCE = 1e18


def is_covariance(matrix: Array) -> bool:
    """Return whether a matrix is finite, symmetric and positive semidefinite.

    Entries beyond 1e18 count as not finite: their products would overflow.
    """
    if not np.all(np.abs(matrix) <= _LARGEST_VARIANCE):
        return False
    scale = float(np.abs(matrix).max(initial=0.0))
    if not np.allclose(matrix, matrix.T, rtol=0.0, atol=1e-6 * scale):
        return False
    return bool(np.linalg.eigvalsh(matrix)[0] >= -1e-6 * scale)


def wrapped(angle: float) -> float:
    """Return the angle in [−π, π]; NaN for an infinite one."""
    return math.remainder(angle, math.tau) if math.isfinite(angle) else math.nan


def predicted(state: Array, dt: float) -> Array:
    """Return the state ``dt`` seconds later at constant acceleration and turn rate.

    The displacement along the base's axes, v dt + a dt²/2, rotated by the initial
    heading (robot_localization's motion model, without height, roll and pitch).
    """
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    forward = state[VX] * dt + 0.5 * state[AX] * dt * dt
    left = state[VY] * dt + 0.5 * state[AY] * dt * dt
    later = state.copy()
    later[X] += c * forward - s * left
    later[Y] += s * forward + c * left
    later[YAW] = wrapped(state[YAW] + state[VYAW] * dt)
    later[VX] += state[AX] * dt
    later[VY] += state[AY] * dt
    return later


def predicted_jacobian(state: Array, dt: float) -> Array:
    """Return ∂predicted / ∂state (8, 8)."""
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    forward = state[VX] * dt + 0.5 * state[AX] * dt * dt
    left = state[VY] * dt + 0.5 * state[AY] * dt * dt
    half = 0.5 * dt * dt
    jacobian = np.eye(SIZE)
    jacobian[X, [YAW, VX, VY, AX, AY]] = (
        -s * forward - c * left,
        c * dt,
        -s * dt,
        c * half,
        -s * half,
    )
    jacobian[Y, [YAW, VX, VY, AX, AY]] = (
        c * forward - s * left,
        s * dt,
        c * dt,
        s * half,
        c * half,
    )
    jacobian[YAW, VYAW] = dt
    jacobian[VX, AX] = dt
    jacobian[VY, AY] = dt
    return jacobian
