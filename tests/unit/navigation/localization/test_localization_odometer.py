import math

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.geometry.geodesy import GeoPoint
from navette.navigation.localization import Odometer, Step

SECOND = 1_000_000_000


def counting(max_gap_ns: int = 2 * SECOND) -> Odometer:
    return Odometer(max_gap_ns)


def test_the_first_message_only_initialises() -> None:
    odometer = counting()
    assert odometer.step_position((100.0, 200.0, 3.0), 0) is Step.STARTED
    assert odometer.distance == 0.0


def test_positions_are_summed_in_three_dimensions() -> None:
    odometer = counting()
    for second, position in enumerate([(0, 0, 0), (1, 2, 2), (1, 2, 0)]):
        odometer.step_position(position, second * SECOND)
    assert odometer.distance == 5.0


def test_velocity_applies_to_the_time_since_the_previous_message() -> None:
    odometer = counting()
    odometer.step_velocity((100.0, 0.0, 0.0), 0)
    assert odometer.step_velocity((3.0, 0.0, 4.0), SECOND // 2) is Step.ADDED
    assert odometer.distance == pytest.approx(2.5)


def test_geographic_positions_use_the_geodesic_and_the_height() -> None:
    odometer = counting()
    # One degree of the meridian from the equator: 110574.3886 m (WGS 84).
    odometer.step_place(GeoPoint(0.0, 11.0, 0.0), 0)
    odometer.step_place(GeoPoint(1.0, 11.0, 1000.0), 1)
    assert odometer.distance == pytest.approx(math.hypot(110574.3886, 1000.0), abs=1e-3)


def test_without_altitude_only_the_geodesic_counts() -> None:
    odometer = counting()
    odometer.step_place(GeoPoint(0.0, 179.5, 20.0), 0)
    odometer.step_place(GeoPoint(0.0, -179.5), 1)  # over the date line
    assert odometer.distance == pytest.approx(111319.4908, abs=1e-3)


@pytest.mark.parametrize("kind", ["position", "velocity", "place"])
@pytest.mark.parametrize("jump_ns", [-1, -400 * SECOND, 2 * SECOND + 1, 400 * SECOND])
def test_a_jump_in_time_adds_nothing_and_counting_continues(kind, jump_ns) -> None:
    odometer = counting()
    step = getattr(odometer, f"step_{kind}")
    stamp_ns, here = 500 * SECOND, np.array([48.0, 11.0, 500.0])
    for _ in range(3):
        step(GeoPoint(*here) if kind == "place" else here, stamp_ns)
        stamp_ns, here = stamp_ns + SECOND, here + 0.001
    so_far = odometer.distance
    assert so_far > 0
    stamp_ns += jump_ns - SECOND
    far = here + 20.0
    expected = Step.WENT_BACK if jump_ns < 0 else Step.GAP
    assert step(GeoPoint(*far) if kind == "place" else far, stamp_ns) is expected
    assert odometer.distance == so_far
    step(GeoPoint(*far) if kind == "place" else far, stamp_ns + SECOND)
    assert (odometer.distance > so_far) is (kind == "velocity")


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_values_that_are_not_finite_have_no_effect(bad: float) -> None:
    odometer = counting()
    odometer.step_position((0.0, 0.0, 0.0), 0)
    assert odometer.step_position((bad, 0.0, 0.0), 1) is Step.REFUSED
    assert odometer.step_velocity((1.0, bad, 0.0), 1) is Step.REFUSED
    assert odometer.step_place(GeoPoint(bad, 0.0, 0.0), 1) is Step.REFUSED
    assert odometer.step_place(GeoPoint(0.0, bad, 0.0), 1) is Step.REFUSED
    odometer.step_position((3.0, 4.0, 0.0), 2)
    assert odometer.distance == 5.0


def test_an_overflow_of_the_distance_is_refused() -> None:
    odometer = counting()
    odometer.step_position((1.7e308, 0.0, 0.0), 0)
    assert odometer.step_position((-1.7e308, 0.0, 0.0), 1) is Step.REFUSED
    assert odometer.step_velocity((1.7e308,) * 3, SECOND) is Step.REFUSED
    assert odometer.distance == 0.0


def test_a_latitude_beyond_the_pole_is_refused() -> None:
    assert counting().step_place(GeoPoint(90.1, 0.0, 0.0), 0) is Step.REFUSED


def test_reset_clears_and_pause_keeps_the_distance() -> None:
    odometer = counting()
    for stamp, x in enumerate([0.0, 2.0]):
        odometer.step_position((x, 0.0, 0.0), stamp)
    odometer.pause()
    assert odometer.step_position((50.0, 0.0, 0.0), 2) is Step.STARTED
    assert odometer.distance == 2.0
    odometer.reset()
    assert odometer.distance == 0.0


def test_a_gap_must_be_positive() -> None:
    with pytest.raises(InvalidValueError, match="max_gap_ns 0"):
        Odometer(0)
