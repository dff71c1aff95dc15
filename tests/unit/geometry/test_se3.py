import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.geometry import (
    Pose2,
    Transform3,
    quaternion_from_rpy,
    quaternion_from_yaw,
    yaw_of,
)

angle = st.floats(-math.pi, math.pi)
coordinate = st.floats(-100, 100)
transforms = st.builds(
    lambda x, y, z, r, p, w: Transform3((x, y, z), quaternion_from_rpy(r, p, w)),
    coordinate,
    coordinate,
    coordinate,
    angle,
    angle,
    angle,
)
points = st.tuples(coordinate, coordinate, coordinate)


@given(transforms, points)
def test_inverse_reverts_apply(
    map_T_base: Transform3, p: tuple[float, float, float]
) -> None:
    back = map_T_base.inverse().apply(map_T_base.apply(p))
    assert back == pytest.approx(p, abs=1e-8)


@given(transforms, transforms, points)
def test_composition_applies_the_right_operand_first(
    a: Transform3, b: Transform3, p: tuple[float, float, float]
) -> None:
    assert (a @ b).apply(p) == pytest.approx(a.apply(b.apply(p)), abs=1e-8)


@given(angle)
def test_yaw_round_trip_through_the_quaternion(yaw: float) -> None:
    assert yaw_of(quaternion_from_yaw(yaw)) == pytest.approx(yaw, abs=1e-9)


def test_rpy_rotates_about_fixed_axes_in_the_order_roll_pitch_yaw() -> None:
    rotation = Transform3((0, 0, 0), quaternion_from_rpy(math.pi / 2, 0, math.pi / 2))
    assert rotation.apply((0.0, 1.0, 0.0)) == pytest.approx((0, 0, 1), abs=1e-12)
    assert rotation.apply((1.0, 0.0, 0.0)) == pytest.approx((0, 1, 0), abs=1e-12)


@given(transforms)
def test_interpolation_keeps_the_ends(map_T_base: Transform3) -> None:
    other = Transform3((1.0, 2.0, 3.0), quaternion_from_yaw(1.0))
    start = map_T_base.interpolate(other, 0.0)
    end = map_T_base.interpolate(other, 1.0)
    probe = (0.3, -0.2, 0.7)
    assert start.apply(probe) == pytest.approx(map_T_base.apply(probe), abs=1e-6)
    assert end.apply(probe) == pytest.approx(other.apply(probe), abs=1e-6)


def test_interpolation_halves_the_angle() -> None:
    a = Transform3.from_pose2(Pose2(0, 0, 0.2))
    b = Transform3.from_pose2(Pose2(4, 0, 1.0))
    middle = a.interpolate(b, 0.5).to_pose2()
    assert middle == pytest.approx((2.0, 0.0, 0.6))
