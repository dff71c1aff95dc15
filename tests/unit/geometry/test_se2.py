import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.geometry import Pose2, angle_difference, wrap_angle

coordinate = st.floats(-1e3, 1e3)
poses = st.builds(Pose2, coordinate, coordinate, st.floats(-math.pi, math.pi))


def assert_same(a: Pose2, b: Pose2) -> None:
    assert a.x == pytest.approx(b.x, abs=1e-8)
    assert a.y == pytest.approx(b.y, abs=1e-8)
    assert angle_difference(a.yaw, b.yaw) == pytest.approx(0.0, abs=1e-9)


@given(poses)
def test_a_pose_times_its_inverse_is_identity(map_T_base: Pose2) -> None:
    assert_same(map_T_base @ map_T_base.inverse(), Pose2(0, 0, 0))


@given(poses, poses, poses)
def test_composition_is_associative(a: Pose2, b: Pose2, c: Pose2) -> None:
    assert_same((a @ b) @ c, a @ (b @ c))


@given(poses, poses, coordinate, coordinate)
def test_apply_agrees_with_composition(a: Pose2, b: Pose2, x: float, y: float) -> None:
    p = np.array([[x, y]])
    np.testing.assert_allclose((a @ b).apply(p), a.apply(b.apply(p)), atol=1e-7)


def test_apply_rotates_counter_clockwise_then_translates() -> None:
    map_T_base = Pose2(1.0, 2.0, math.pi / 2)
    np.testing.assert_allclose(map_T_base.apply(np.array([[1.0, 0.0]])), [[1.0, 3.0]])


@given(st.floats(-1e4, 1e4))
def test_wrapped_angles_lie_in_the_half_open_circle(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


def test_minus_pi_wraps_to_plus_pi() -> None:
    assert wrap_angle(-math.pi) == math.pi


def test_interpolation_takes_the_shorter_turn() -> None:
    a, b = Pose2(0, 0, math.radians(170)), Pose2(2, 0, math.radians(-170))
    middle = a.interpolate(b, 0.5)
    assert middle.x == 1.0
    assert abs(middle.yaw) == pytest.approx(math.pi)
