"""angles: ranges, and rotations that keep limits."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.ros2.packages.angles import (
    normalize_angle,
    normalize_angle_positive,
    shortest_angular_distance,
    shortest_angular_distance_with_large_limits,
    shortest_angular_distance_with_limits,
    two_pi_complement,
)

ANY = st.floats(-50.0, 50.0)
ANGLE = st.floats(-math.pi, math.pi)


@given(ANY)
def test_ranges(angle: float) -> None:
    assert 0.0 <= normalize_angle_positive(angle) <= 2.0 * math.pi
    assert -math.pi <= normalize_angle(angle) <= math.pi
    assert math.cos(normalize_angle(angle) - angle) == pytest.approx(1.0)


@given(ANY, ANY)
def test_the_shortest_rotation_leads_there(start: float, end: float) -> None:
    rotation = shortest_angular_distance(start, end)
    assert abs(rotation) <= math.pi
    assert math.cos(start + rotation - end) == pytest.approx(1.0)
    other = two_pi_complement(rotation)
    assert abs(rotation) + abs(other) == pytest.approx(2.0 * math.pi)


@pytest.mark.parametrize(
    ("start", "end", "left", "right", "expected"),
    [
        (-0.5, 0.5, -0.25, 0.25, (False, 1.0)),
        (-0.5, 0.5, 0.25, -0.25, (True, 1.0 - 2.0 * math.pi)),
        (0.5, -0.5, 0.25, -0.25, (True, 2.0 * math.pi - 1.0)),
        (0.0, 1.0, -0.5, 0.5, (False, 1.0)),
        (-math.pi, 2.8, -math.pi, math.pi, (True, math.pi + 2.8)),
    ],
)
def test_limits(
    start: float, end: float, left: float, right: float, expected: tuple[bool, float]
) -> None:
    found = shortest_angular_distance_with_limits(start, end, left, right)
    assert found == (expected[0], pytest.approx(expected[1]))


@given(ANGLE, ANGLE, ANGLE, ANGLE)
def test_a_rotation_within_limits_passes_no_other_angle(
    start: float, end: float, left: float, right: float
) -> None:
    is_found, rotation = shortest_angular_distance_with_limits(start, end, left, right)
    assert math.cos(start + rotation - end) == pytest.approx(1.0)
    if is_found and (left, right) != (-math.pi, math.pi):
        width = (right - left) % (2.0 * math.pi)
        for part in (0.25, 0.5, 0.75):
            offset = (start + part * rotation - left) % (2.0 * math.pi)
            assert offset <= width + 1e-9 or offset >= 2.0 * math.pi - 1e-9


@pytest.mark.parametrize(
    ("start", "end", "limits", "expected"),
    [
        (0.0, 10.5, (-2.0, 2.0), (True, 0.5)),
        (10.5, 0.0, (-2.0, 2.0), (False, -0.5)),
        (0.0, 10.5, (-2.0, 0.1), (True, -1.5)),
        (0.0, 0.5, (2.0, -2.0), (False, 0.5)),
    ],
)
def test_large_limits_in_half_turns(
    start: float, end: float, limits: tuple[float, float], expected: tuple[bool, float]
) -> None:
    scale = math.pi
    is_found, rotation = shortest_angular_distance_with_large_limits(
        start * scale, end * scale, limits[0] * scale, limits[1] * scale
    )
    assert (is_found, rotation) == (expected[0], pytest.approx(expected[1] * scale))
