"""tf_transformations: every sequence of axes, gimbal lock, quaternions, matrices."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from navette.errors import InvalidValueError
from navette.ros2.packages import tf_transformations as tft

SEQUENCES = [
    f"{frame}{a}{b}{c}"
    for frame in "sr"
    for a, b, c in itertools.product("xyz", repeat=3)
    if a != b != c
]
ANGLE = st.floats(-3.1, 3.1)


def reference(angles: tuple[float, float, float], axes: str) -> Rotation:
    """Return SciPy's rotation; its names of rotating axes are capital sequence."""
    sequence = axes[1:].upper() if axes[0] == "r" else axes[1:]
    return Rotation.from_euler(sequence, angles)


def test_there_are_24() -> None:
    assert len(SEQUENCES) == 24


@given(st.sampled_from(SEQUENCES), ANGLE, ANGLE, ANGLE)
def test_all_sequences(axes: str, ai: float, aj: float, ak: float) -> None:
    expected = reference((ai, aj, ak), axes).as_matrix()
    assert np.allclose(tft.euler_matrix(ai, aj, ak, axes)[:3, :3], expected)
    quaternion = tft.quaternion_from_euler(ai, aj, ak, axes)
    back = tft.euler_from_quaternion(quaternion, axes)
    assert np.allclose(reference(back, axes).as_matrix(), expected, atol=1e-6)
    from_matrix = tft.quaternion_from_matrix(expected)
    assert from_matrix[3] >= 0
    assert abs(np.dot(from_matrix, quaternion)) == pytest.approx(1)


@pytest.mark.parametrize("axes", SEQUENCES)
@pytest.mark.parametrize("middle", [0.0, math.pi / 2, -math.pi / 2, math.pi])
def test_gimbal_lock(axes: str, middle: float) -> None:
    expected = reference((0.3, middle, 0.4), axes).as_matrix()
    back = tft.euler_from_matrix(expected, axes)
    assert np.allclose(reference(back, axes).as_matrix(), expected, atol=1e-6)


def test_roll_pitch_yaw() -> None:
    angles = (0.1, -0.2, 3.0)
    quaternion = tft.quaternion_from_euler(*angles)
    assert tft.euler_from_quaternion(quaternion) == pytest.approx(angles)
    half = math.sqrt(0.5)
    assert tft.quaternion_from_euler(0, 0, math.pi / 2) == pytest.approx(
        [0, 0, half, half]
    )


def test_quaternions() -> None:
    a = tft.quaternion_about_axis(0.4, (0, 0, 2))
    b = tft.quaternion_from_euler(0.3, 0.2, 0.1)
    one = [0, 0, 0, 1]
    assert tft.quaternion_multiply(b, tft.quaternion_inverse(b)) == pytest.approx(one)
    assert tft.quaternion_inverse(a) == pytest.approx(tft.quaternion_conjugate(a))
    assert tft.quaternion_inverse(2 * a) == pytest.approx(
        tft.quaternion_conjugate(a) / 2
    )
    product = tft.concatenate_matrices(
        tft.quaternion_matrix(a), tft.quaternion_matrix(b)
    )
    assert np.allclose(tft.quaternion_matrix(tft.quaternion_multiply(a, b)), product)
    middle = tft.quaternion_slerp(one, tft.quaternion_multiply(a, a), 0.5)
    assert middle == pytest.approx(a)


def test_matrices() -> None:
    moved = tft.translation_matrix((1, 2, 3))
    assert tft.translation_from_matrix(moved).tolist() == [1, 2, 3]
    there_and_back = tft.concatenate_matrices(moved, tft.inverse_matrix(moved))
    assert np.allclose(there_and_back, tft.identity_matrix())


def test_wrong_use() -> None:
    with pytest.raises(InvalidValueError, match="axes 'sxxz': expected s or r"):
        tft.quaternion_from_euler(0, 0, 0, "sxxz")
    with pytest.raises(InvalidValueError, match=r"expected \(x, y, z, w\)"):
        tft.euler_from_quaternion((0, 0, 1))
    with pytest.raises(InvalidValueError, match="is not a rotation"):
        tft.euler_from_quaternion((0, 0, 0, 0))
    with pytest.raises(InvalidValueError, match="has no direction"):
        tft.quaternion_about_axis(1.0, (0, 0, 0))
