"""Prediction and correction of the filter's mean and covariance, compiled.

With matrices this small, the overhead of NumPy's calls made a step take 133 µs;
compiled, it takes 18 µs.
"""

import math

import numpy as np

from navette.files.kernels import kernel
from navette.navigation.localization.ekf.measurement import (
    Indices,
    jacobian_of,
    residual,
)
from navette.navigation.localization.ekf.state import (
    VX,
    VYAW,
    YAW,
    Array,
    decompose,
    predicted,
    predicted_jacobian,
    wrapped,
)


@kernel
def predict(
    state: Array, covariance: Array, process_noise: Array, dt: float, scales_noise: bool
) -> tuple[Array, Array]:
    """Return state (8,) and covariance (8, 8) ``dt`` seconds later.

    The noise of the motion is the integral ∫ F(τ) Q F(τ)ᵀ dτ by Simpson's rule (exact
    for velocities: Bar-Shalom, Li, Kirubarajan 2001, section 6.2). The noise of a
    velocity correlates with that of the pose, so that the next measured velocity also
    corrects the pose of this step; otherwise a turn would be integrated late.

    Args:
        process_noise: Q (8, 8), added per second.
        scales_noise: multiply that of the pose by the squared norm of the velocity.
    """
    Q = process_noise.copy()
    if scales_noise:
        squared = 0.0
        for i in range(VX, VYAW + 1):
            squared += state[i] * state[i]
        for i in range(YAW + 1):
            for j in range(YAW + 1):
                Q[i, j] *= squared
    half, whole = predicted_jacobian(state, 0.5 * dt), predicted_jacobian(state, dt)
    later = _propagated(whole, covariance)
    _add(later, dt / 6.0, Q)
    _add(later, dt / 6.0 * 4.0, _propagated(half, Q))
    _add(later, dt / 6.0, _propagated(whole, Q))
    _symmetrise(later)
    return predicted(state, dt), later


@kernel
def correct(
    state: Array,
    prior: Array,
    rows: Indices,
    values: Array,
    noise: Array,
    lever: tuple[float, float],
) -> tuple[float, Array, Array, Array, Array]:
    """Return how far a measurement is from the estimate, and the corrected estimate.

    The covariance is updated in Joseph's form (Bucy and Joseph 1968), which keeps it
    symmetric and positive for any rounding of the gain.

    Args:
        state: (8,) estimate.
        prior: (8, 8) its covariance.
        rows, values, noise, lever: of the
            :class:`~navette.navigation.localization.ekf.measurement.Measurement`.

    Returns:
        Squared Mahalanobis distance, NaN if its covariance has no inverse; difference
        (n,) and its covariance (n, n); corrected state (8,) and covariance (8, 8).
    """
    difference = residual(rows, values, lever, state)
    H = jacobian_of(rows, lever, state)
    S = _propagated(H, prior)
    _add(S, 1.0, noise)
    gain = _by_transposed(prior, H)
    lower = S.copy()
    if not decompose(lower):
        return np.nan, difference, S, state, prior
    for i in range(state.size):
        _solve(lower, gain[i])
    weighted, squared = difference.copy(), 0.0
    _solve(lower, weighted)
    later, kept = state.copy(), np.eye(state.size)
    for k in range(rows.size):
        squared += difference[k] * weighted[k]
        for i in range(state.size):
            later[i] += gain[i, k] * difference[k]
    later[YAW] = wrapped(later[YAW])
    for i in range(state.size):
        for j in range(state.size):
            for k in range(rows.size):
                kept[i, j] -= gain[i, k] * H[k, j]
    corrected = _propagated(kept, prior)
    _add(corrected, 1.0, _propagated(gain, noise))
    _symmetrise(corrected)
    return squared, difference, S, later, corrected


@kernel(allocates=False)
def are_finite(state: Array, covariance: Array) -> bool:
    """Return whether all entries of an estimate are finite."""
    total = 0.0
    for i in range(covariance.shape[0]):
        total += abs(state[i])
        for j in range(covariance.shape[1]):
            total += abs(covariance[i, j])
    return math.isfinite(total)


@kernel
def _by_transposed(a: Array, b: Array) -> Array:
    """Return A Bᵀ; a transposed array would be another type, to be compiled for."""
    product = np.zeros((a.shape[0], b.shape[0]))
    for i in range(a.shape[0]):
        for j in range(b.shape[0]):
            for k in range(a.shape[1]):
                product[i, j] += a[i, k] * b[j, k]
    return product


@kernel
def _propagated(jacobian: Array, covariance: Array) -> Array:
    """Return J P Jᵀ of a symmetric P."""
    return _by_transposed(_by_transposed(jacobian, covariance), jacobian)


@kernel(allocates=False)
def _symmetrise(matrix: Array) -> None:
    """Remove what rounding, and given covariances, differ by from symmetric ones."""
    for i in range(matrix.shape[0]):
        for j in range(i):
            matrix[i, j] = matrix[j, i] = 0.5 * (matrix[i, j] + matrix[j, i])


@kernel(allocates=False)
def _add(matrix: Array, share: float, other: Array) -> None:
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            matrix[i, j] += share * other[i, j]


@kernel(allocates=False)
def _solve(lower: Array, right: Array) -> None:
    """Solve L Lᵀ x = b for one right side (n,), in place."""
    n = lower.shape[0]
    for i in range(n):
        for k in range(i):
            right[i] -= lower[i, k] * right[k]
        right[i] /= lower[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] -= lower[k, i] * right[k]
        right[i] /= lower[i, i]
