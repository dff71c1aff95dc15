import math

import numpy as np
import pytest

from navette.errors import InvalidValueError, ParameterError
from navette.navigation.localization.ekf import (
    EkfParams,
    Fused,
    Measurement,
    OrderedEkf,
    PlanarEkf,
)
from navette.navigation.localization.ekf.state import (
    SIZE,
    VX,
    VYAW,
    YAW,
    X,
    Y,
    planar_covariance,
)

SECOND = 1_000_000_000


def new_filter(noise: float = 0.05) -> PlanarEkf:
    return PlanarEkf(noise * np.eye(SIZE), 1e-9 * np.eye(SIZE))


def seen(index: int, value: float, stamp_ns: int = 0, variance: float = 0.01, **more):
    values, covariance = np.array([value]), np.array([[variance]])
    source = more.pop("source", "odom0")
    return Measurement(source, stamp_ns, (index,), values, covariance, **more)


def test_no_estimate_before_the_first_measurement() -> None:
    ekf = new_filter()
    assert ekf.stamp_ns is None
    assert ekf.estimate_at(0) is None


def test_the_first_measurement_of_an_entry_replaces_its_initial_value() -> None:
    ekf = new_filter()
    ekf.step(seen(X, 5.0, variance=0.25))
    estimate = ekf.estimate_at(0)
    assert estimate.state[X] == pytest.approx(5.0, abs=1e-5)
    assert estimate.covariance[X, X] == pytest.approx(0.25, rel=1e-5)
    assert estimate.covariance[Y, Y] == 1e-9


def test_a_known_initial_value_is_weighted() -> None:
    covariance = 0.25 * np.eye(SIZE)
    ekf = PlanarEkf(0.0 * covariance, covariance, np.ones(SIZE), frozenset({X}))
    for _ in range(2):
        ekf.step(seen(X, 6.0, variance=1.0))
        assert ekf.estimate_at(0).state[X] == pytest.approx(2.0)
        assert ekf.estimate_at(0).covariance[X, X] == pytest.approx(0.2)
        ekf.reset()


def test_two_measurements_are_weighted_by_their_variances() -> None:
    ekf = new_filter(noise=0.0)
    ekf.step(seen(X, 0.0, variance=1.0))
    ekf.step(seen(X, 10.0, variance=0.25))
    estimate = ekf.estimate_at(0)
    assert estimate.state[X] == pytest.approx(8.0, abs=1e-4)
    assert estimate.covariance[X, X] == pytest.approx(0.2, rel=1e-4)


def test_headings_are_fused_across_the_wrap() -> None:
    ekf = new_filter(noise=0.0)
    for degrees in (170.0, -170.0):
        ekf.step(seen(YAW, math.radians(degrees)))
    assert abs(ekf.snapshot.state[YAW]) == pytest.approx(math.pi, abs=1e-5)


def test_prediction_follows_the_model_and_increases_the_variance() -> None:
    ekf = new_filter()
    ekf.step(seen(VX, 2.0, variance=1e-6))
    later = ekf.estimate_at(3 * SECOND)
    assert later.state[X] == pytest.approx(6.0, abs=1e-3)
    assert later.covariance[X, X] > ekf.snapshot.covariance[X, X]
    assert ekf.stamp_ns == 0
    assert ekf.estimate_at(-SECOND).stamp_ns == 0


def test_an_outlier_is_rejected_without_effect() -> None:
    ekf = new_filter(noise=0.0)
    ekf.step(seen(X, 0.0))
    before = ekf.snapshot.state
    far = seen(X, 2.0, threshold=3.0)
    assert ekf.step(far) is Fused.REJECTED
    np.testing.assert_array_equal(ekf.snapshot.state, before)
    assert ekf.step(seen(X, 0.2, threshold=3.0)) is Fused.USED


def ordered(history_s: float = 1.0) -> OrderedEkf:
    return OrderedEkf(new_filter(), round(history_s * 1e9), 10 * SECOND)


def test_a_measurement_older_than_the_history_is_refused() -> None:
    ekf = ordered()
    ekf.step(seen(X, 1.0, stamp_ns=5 * SECOND))
    before = ekf.ekf.snapshot
    old = seen(X, 9.0, stamp_ns=4 * SECOND - 1, source="gps0")
    assert ekf.step(old) is Fused.TOO_OLD
    assert ekf.ekf.snapshot is before
    assert not ekf.is_new_run("gps0", 4 * SECOND - 1)


def test_the_history_is_bounded() -> None:
    ekf = ordered(history_s=0.5)
    for tick in range(1000):
        ekf.step(seen(X, 0.0, stamp_ns=tick * SECOND // 100))
    assert len(ekf._entries) <= 51


def test_a_jump_of_a_sensors_time_means_a_new_run() -> None:
    ekf = ordered()
    ekf.step(seen(X, 1.0, stamp_ns=100 * SECOND))
    assert not ekf.is_new_run("odom0", 99 * SECOND)
    assert ekf.is_new_run("odom0", 99 * SECOND - 1)
    assert not ekf.is_new_run("imu0", 50 * SECOND)  # late, but not a jump
    assert not ekf.is_new_run("imu0", 110 * SECOND)
    assert ekf.is_new_run("imu0", 110 * SECOND + 1)
    ekf.reset()
    assert not ekf.is_new_run("odom0", 0)


def test_noise_is_15_variances_or_the_full_matrix() -> None:
    variances = tuple(float(i) for i in range(1, 16))
    expected = np.diag([1.0, 2.0, 6.0, 7.0, 8.0, 12.0, 13.0, 14.0])
    np.testing.assert_array_equal(planar_covariance(variances, "noise"), expected)
    whole = tuple(np.diag(variances).ravel().tolist())
    np.testing.assert_array_equal(planar_covariance(whole, "noise"), expected)
    with pytest.raises(InvalidValueError, match="noise: 3 numbers; expected 15"):
        planar_covariance((1.0, 2.0, 3.0), "noise")
    with pytest.raises(InvalidValueError, match="without negative eigenvalues"):
        planar_covariance((-1.0,) * 15, "noise")


def config(*names: str) -> tuple[bool, ...]:
    order = "x y z roll pitch yaw vx vy vz vroll vpitch vyaw ax ay az".split()
    return tuple(name in names for name in order)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"two_d_mode": False}, "expected true"),
        ({"world_frame": "earth"}, "'earth'; expected the odom_frame 'odom'"),
        ({"odom0": "/odom"}, "no entry is used of /odom"),
        ({"odom0": "/odom", "odom0_config": (True,)}, "1 booleans; expected 15"),
        ({"odom0": "/odom", "odom0_config": config("x", "z")}, "z is chosen.*planar"),
        ({"imu0": "/imu", "imu0_config": config("x")}, "x is chosen.*not provide it"),
        ({"process_noise_covariance": (1.0,)}, "1 numbers; expected 15"),
        ({"gps0": "/fix", "gps0_datum_deg": (91.0, 0.0)}, "expected latitude"),
        ({"odom0_pose_rejection_threshold": 0.0}, "rejection_threshold"),
    ],
)
def test_wrong_parameters_are_named(values, text) -> None:
    with pytest.raises(ParameterError, match=text):
        EkfParams(**values)


def test_an_unknown_input_is_named() -> None:
    with pytest.raises(
        ParameterError,
        match=r"unknown parameter 'odom7'; did you mean 'odom1' or 'odom0'\?",
    ):
        EkfParams.from_dict({"odom7": "/odom"})


def test_turning_follows_the_measured_rate() -> None:
    ekf = new_filter(noise=1e-6)
    for tick in range(11):
        stamp_ns = tick * SECOND // 10
        ekf.step(seen(VX, 1.0, stamp_ns, 1e-6))
        ekf.step(seen(VYAW, math.pi / 2, stamp_ns, 1e-6))
    # A quarter of a circle of radius 2/π, in chords of 9° each.
    assert ekf.snapshot.state[YAW] == pytest.approx(math.pi / 2, abs=1e-3)
    assert np.hypot(*ekf.snapshot.state[[X, Y]]) == pytest.approx(0.9, abs=0.01)
