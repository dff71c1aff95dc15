"""State of a robot in the plane, and its motion model.

State (8,): x, y (m) and yaw (rad) of the base in the world frame; vx, vy (m/s), vyaw
(rad/s), ax, ay (m/s²) of the base along its own axes.
"""

import math

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel

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
    return bool(_is_covariance(np.ascontiguousarray(matrix, np.float64)))


@kernel
def _is_covariance(matrix: Array) -> bool:
    size, scale = matrix.shape[0], 0.0
    for i in range(size):
        for j in range(size):
            if not abs(matrix[i, j]) <= _LARGEST_VARIANCE:
                return False
            scale = max(scale, abs(matrix[i, j]))
    tolerance = 1e-6 * scale
    raised = matrix.copy()
    for i in range(size):
        raised[i, i] += tolerance
        for j in range(i):
            if abs(matrix[i, j] - matrix[j, i]) > tolerance:
                return False
    return scale == 0.0 or bool(decompose(raised))


@kernel(allocates=False)
def decompose(matrix: Array) -> bool:
    """Write Cholesky's factor over the lower half; return whether there is one."""
    for j in range(matrix.shape[0]):
        for i in range(j, matrix.shape[0]):
            for k in range(j):
                matrix[i, j] -= matrix[i, k] * matrix[j, k]
            if i > j:
                matrix[i, j] /= matrix[j, j]
            elif matrix[j, j] > 0.0 and math.isfinite(matrix[j, j]):
                matrix[j, j] = math.sqrt(matrix[j, j])
            else:
                return False
    return True


@kernel(allocates=False)
def wrapped(angle: float) -> float:
    """Return the angle in [−π, π]; NaN for an infinite one."""
    turns: float = np.floor(angle / math.tau + 0.5)
    return angle - math.tau * turns


@kernel
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


@kernel
def predicted_jacobian(state: Array, dt: float) -> Array:
    """Return ∂predicted / ∂state (8, 8)."""
    c, s = math.cos(state[YAW]), math.sin(state[YAW])
    forward = state[VX] * dt + 0.5 * state[AX] * dt * dt
    left = state[VY] * dt + 0.5 * state[AY] * dt * dt
    half = 0.5 * dt * dt
    jacobian = np.eye(SIZE)
    jacobian[X, YAW], jacobian[Y, YAW] = -s * forward - c * left, c * forward - s * left
    jacobian[X, VX], jacobian[X, VY] = c * dt, -s * dt
    jacobian[Y, VX], jacobian[Y, VY] = s * dt, c * dt
    jacobian[X, AX], jacobian[X, AY] = c * half, -s * half
    jacobian[Y, AX], jacobian[Y, AY] = s * half, c * half
    jacobian[YAW, VYAW] = jacobian[VX, AX] = jacobian[VY, AY] = dt
    return jacobian
