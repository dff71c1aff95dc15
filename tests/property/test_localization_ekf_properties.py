"""The filter's mathematics: Jacobians, covariances, consistency, order."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.navigation.localization.ekf import (
    Fused,
    Measurement,
    OrderedEkf,
    PlanarEkf,
)
from navette.navigation.localization.ekf.kalman import correct, predict
from navette.navigation.localization.ekf.measurement import (
    expected,
    expected_jacobian,
    innovation,
)
from navette.navigation.localization.ekf.state import (
    SIZE,
    VX,
    VY,
    VYAW,
    YAW,
    X,
    Y,
    is_covariance,
    predicted,
    predicted_jacobian,
)

MS = 1_000_000
small = st.floats(-5.0, 5.0)
states = st.tuples(*[small] * SIZE).map(np.array)


def numeric_jacobian(function, state):
    """Central differences; the heading's turn by 2π is taken out."""
    step = 1e-6
    columns = []
    for index in range(SIZE):
        nudge = np.zeros(SIZE)
        nudge[index] = step
        change = function(state + nudge) - function(state - nudge)
        change = np.where(
            np.abs(change) > 1.0, change - np.sign(change) * math.tau, change
        )
        columns.append(change / (2 * step))
    return np.array(columns).T


@given(states, st.floats(0.0, 2.0))
def test_the_models_jacobian_matches_finite_differences(state, dt) -> None:
    slope = numeric_jacobian(lambda s: predicted(s, dt), state)
    np.testing.assert_allclose(predicted_jacobian(state, dt), slope, atol=1e-6)


@given(states, small, small)
def test_a_measurements_jacobian_matches_finite_differences(state, lx, ly) -> None:
    seen = Measurement(
        "gps0", 0, (X, Y, YAW, VX), np.zeros(4), np.eye(4), lever=(lx, ly)
    )
    slope = numeric_jacobian(lambda s: expected(seen, s), state)
    np.testing.assert_allclose(expected_jacobian(seen, state), slope, atol=1e-6)


def random_measurement(rng: np.random.Generator, stamp_ns: int) -> Measurement:
    count = int(rng.integers(1, SIZE + 1))
    indices = tuple(sorted(rng.choice(SIZE, count, replace=False).tolist()))
    root = rng.normal(size=(count, count)) * 10.0 ** rng.integers(-4, 3)
    covariance = root @ root.T + 1e-9 * np.eye(count)
    lever = tuple(rng.normal(size=2))
    return Measurement(
        "odom0", stamp_ns, indices, rng.normal(size=count) * 3, covariance, lever=lever
    )


def new_filter(noise: float = 0.05, initial: float = 1e-9) -> PlanarEkf:
    return PlanarEkf(noise * np.eye(SIZE), initial * np.eye(SIZE))


@given(st.integers(0, 2**32 - 1))
def test_the_covariance_stays_symmetric_and_positive(seed: int) -> None:
    rng = np.random.default_rng(seed)
    ekf, stamp_ns = new_filter(), 0
    for _ in range(30):
        stamp_ns += int(rng.integers(0, 2000)) * MS
        ekf.step(random_measurement(rng, stamp_ns))
        covariance = ekf.snapshot.covariance
        assert np.array_equal(covariance, covariance.T)
        values = np.linalg.eigvalsh(covariance)
        assert values[0] >= -1e-12 * values[-1]
        assert np.all(np.isfinite(ekf.snapshot.state))
        assert abs(ekf.snapshot.state[YAW]) <= math.pi


@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 2.0))
def test_the_compiled_steps_match_their_formulas(seed: int, dt: float) -> None:
    rng = np.random.default_rng(seed)
    state, root = rng.normal(size=SIZE), rng.normal(size=(2, SIZE, SIZE))
    P, Q = root[0] @ root[0].T, root[1] @ root[1].T
    F, half = predicted_jacobian(state, dt), predicted_jacobian(state, dt / 2)
    noise = dt / 6 * (Q + 4 * half @ Q @ half.T + F @ Q @ F.T)
    _, later = predict(state, P, Q, dt, False)
    np.testing.assert_allclose(later, F @ P @ F.T + noise, rtol=1e-9, atol=1e-9)

    seen = random_measurement(rng, 0)
    d, H = innovation(seen, state), expected_jacobian(seen, state)
    S = H @ P @ H.T + seen.covariance
    K = np.linalg.solve(S, H @ P).T
    squared, difference, spread, corrected, covariance = correct(
        state, P, seen.rows, seen.values, seen.covariance, seen.lever
    )
    tolerance = {"rtol": 1e-6, "atol": 1e-6 * np.linalg.cond(S) ** 0.5}
    np.testing.assert_array_equal(difference, d)
    np.testing.assert_allclose(spread, S)
    np.testing.assert_allclose(squared, d @ np.linalg.solve(S, d), **tolerance)
    moved = corrected - (state + K @ d)
    moved[YAW] = math.remainder(moved[YAW], math.tau)
    np.testing.assert_allclose(moved, 0.0, **tolerance)
    np.testing.assert_allclose(covariance, P - K @ H @ P, **tolerance)


@given(st.integers(0, 2**32 - 1), st.integers(1, SIZE))
def test_a_covariance_has_no_negative_eigenvalue(seed: int, size: int) -> None:
    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(size, size)))[0]
    values = rng.choice([0.0, 1e-3, 1.0, 1e3], size) * 10.0 ** rng.integers(-9, 9)
    assert is_covariance(axes * values @ axes.T)
    largest = max(values.max(), 1e-9)
    values[rng.integers(size)] = -1e-3 * largest
    assert not is_covariance(axes * values @ axes.T)


wild = st.floats(allow_nan=False, allow_infinity=False)


@given(st.lists(st.tuples(wild, st.floats(1e-9, 1e300)), min_size=1, max_size=8))
def test_no_measurement_makes_the_estimate_infinite(values) -> None:
    ekf = new_filter()
    for tick, (value, variance) in enumerate(values):
        seen = np.array([value, -value]), np.diag([variance, variance])
        result = ekf.step(Measurement("odom0", tick * 10**9, (X, VX + tick % 5), *seen))
        assert result in (Fused.USED, Fused.UNSOUND)
        assert ekf.snapshot.is_finite


@given(st.integers(0, 2**32 - 1), st.integers(0, 2**32 - 1))
def test_the_order_of_arrival_does_not_matter(seed: int, shuffle: int) -> None:
    rng = np.random.default_rng(seed)
    stamps = (np.cumsum(rng.integers(1, 50, 12)) * MS).tolist()
    measurements = [random_measurement(rng, stamp) for stamp in stamps]
    in_order = OrderedEkf(new_filter(), 10**9, 10**10)
    for each in measurements:
        in_order.step(each)
    mixed = OrderedEkf(new_filter(), 10**9, 10**10)
    for index in np.random.default_rng(shuffle).permutation(len(measurements)):
        assert mixed.step(measurements[index]) is not Fused.TOO_OLD
    assert mixed.ekf.stamp_ns == in_order.ekf.stamp_ns
    np.testing.assert_array_equal(mixed.ekf.snapshot.state, in_order.ekf.snapshot.state)
    np.testing.assert_array_equal(
        mixed.ekf.snapshot.covariance, in_order.ekf.snapshot.covariance
    )


NOISE = np.diag([1e-5, 1e-5, 1e-5, 0.02, 1e-4, 0.02, 1e-4, 1e-4])
WHEELS = np.diag([0.05, 0.02, 0.03]) ** 2
POSITION = np.diag([0.5, 0.5]) ** 2


def drive(rng: np.random.Generator) -> tuple[PlanarEkf, np.ndarray, list[float]]:
    """A minute by the model with its own noise; NEES (8 numbers) once a second."""
    truth = np.zeros(SIZE)
    truth[VX], truth[VYAW] = 1.0, 0.2
    ekf = PlanarEkf(NOISE, 1e-9 * np.eye(SIZE))
    errors: list[float] = []
    for tick in range(1, 601):
        truth = predicted(truth, 0.1) + rng.multivariate_normal(
            np.zeros(SIZE), 0.1 * NOISE
        )
        stamp_ns = tick * 100 * MS
        seen = truth[[VX, VY, VYAW]] + rng.multivariate_normal(np.zeros(3), WHEELS)
        ekf.step(Measurement("odom0", stamp_ns, (VX, VY, VYAW), seen, WHEELS))
        if tick % 5 == 0:
            place = truth[[X, Y]] + [math.cos(truth[YAW]), math.sin(truth[YAW])]
            place = place + rng.multivariate_normal(np.zeros(2), POSITION)
            ekf.step(
                Measurement("gps0", stamp_ns, (X, Y), place, POSITION, lever=(1.0, 0.0))
            )
        if tick % 10 == 0:
            error = ekf.snapshot.state - truth
            error[YAW] = math.remainder(error[YAW], math.tau)
            errors.append(error @ np.linalg.solve(ekf.snapshot.covariance, error))
    return ekf, truth, errors


@pytest.mark.slow
def test_the_filters_error_matches_its_covariance() -> None:
    """Normalised estimation error squared (Bar-Shalom et al. 2001, section 5.4).

    Its mean over runs is χ² with 8 degrees of freedom: 8 ± 3·√(16 / 20) at each time
    for 20 runs; over all times they are correlated, so the bounds stay these.
    """
    runs = [drive(np.random.default_rng(seed)) for seed in range(20)]
    nees = np.array([errors for _, _, errors in runs])
    assert 8 - 2.7 < nees.mean() < 8 + 2.7
    inside = np.abs(nees.mean(axis=0) - 8) < 3 * math.sqrt(16 / 20)
    assert inside.mean() > 0.9
    position = [
        np.hypot(*(ekf.snapshot.state - truth)[[X, Y]]) for ekf, truth, _ in runs
    ]
    assert np.mean(position) < 0.4  # a single fix is wrong by 0.63 m
