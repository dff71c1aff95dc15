import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt

from navette.errors import InvalidValueError
from navette.navigation.grids import distance_field
from navette.navigation.grids.checks import kernel_array


def squares(occupied: np.ndarray, radius: int) -> np.ndarray:
    """Squared distances in cells, clipped to the square of the radius."""
    field = distance_field(occupied, 1.0, radius).astype(np.float64)
    return np.rint(field**2).astype(int)


def oracle(occupied: np.ndarray, radius: int) -> np.ndarray:
    """Squared distances by SciPy, clipped to the square of the radius."""
    if not occupied.any():
        return np.full(occupied.shape, radius**2)
    squared = np.rint(distance_transform_edt(occupied == 0) ** 2)
    return np.minimum(squared, radius**2).astype(int)


@pytest.mark.parametrize("shape", [(1, 1), (1, 200), (200, 1), (63, 129), (40, 64)])
@pytest.mark.parametrize("radius", [0, 1, 3, 20, 179, 180, 250])
def test_distances_equal_the_exact_transform(shape, radius) -> None:
    rng = np.random.default_rng(radius)
    for density in (0.0005, 0.02, 0.4):
        occupied = (rng.random(shape) < density).astype(np.uint8)
        np.testing.assert_array_equal(
            squares(occupied, radius), oracle(occupied, radius)
        )


def test_any_non_zero_value_is_an_obstacle() -> None:
    occupied = np.array([[0, 0, 255, 0]], np.uint8)
    assert distance_field(occupied, 1.0, 5.0).tolist() == [[2, 1, 0, 1]]


def test_everything_is_far_without_obstacles() -> None:
    assert (distance_field(np.zeros((5, 300), np.uint8), 1.0, 7.0) == 7.0).all()


def test_a_radius_beyond_the_grid_changes_nothing() -> None:
    occupied = np.zeros((12, 30), np.uint8)
    assert (distance_field(occupied, 0.1, 1000.0) == 1000.0).all()
    occupied[0, 0] = 1
    field = distance_field(occupied, 0.1, 1000.0)
    assert field[11, 29] == pytest.approx(0.1 * np.hypot(11, 29))
    np.testing.assert_array_equal(squares(occupied, 40_000), squares(occupied, 40))


def test_field_is_in_metres_and_clipped() -> None:
    occupied = np.zeros((3, 9), np.uint8)
    occupied[1, 0] = 1
    field = distance_field(occupied, 0.1, 0.45)
    assert field.dtype == np.float32
    np.testing.assert_allclose(
        field[1], [0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.45, 0.45, 0.45], rtol=1e-6
    )
    assert field[0, 1] == pytest.approx(0.1 * 2**0.5)


def test_read_only_and_strided_arrays_are_accepted() -> None:
    occupied = np.zeros((20, 30), np.uint8)
    occupied[5, 7] = 1
    frozen = occupied.copy()
    frozen.flags.writeable = False
    expected = squares(occupied, 6)
    np.testing.assert_array_equal(squares(frozen, 6), expected)
    np.testing.assert_array_equal(squares(occupied.T, 6), expected.T)


def test_unaligned_arrays_are_accepted() -> None:
    """Deserialised messages can hold views into bytes."""
    ranges = np.frombuffer(b"x" + np.ones(4, np.float32).tobytes(), np.float32, 4, 1)
    assert not ranges.flags.aligned
    assert kernel_array("ranges", ranges, np.float32, 1).flags.carray


@pytest.mark.parametrize(
    ("occupied", "radius", "text"),
    [
        (np.zeros((3, 3), bool), 2, "occupied: dtype bool, expected uint8"),
        (np.zeros(3, np.uint8), 2, "occupied: 1-D, expected 2-D"),
        (np.zeros((0, 3), np.uint8), 2, r"occupied: shape \(0, 3\)"),
        ([[0]], 2, "occupied: list, expected a uint8 array"),
        (np.zeros((3, 3), np.uint8), 50_000, "must be at most 46339"),
        (np.zeros((3, 3), np.uint8), -1, "max_distance_m: -1, must be >= 0"),
    ],
)
def test_bad_input_is_named(occupied, radius, text) -> None:
    with pytest.raises(InvalidValueError, match=text):
        distance_field(occupied, 1.0, radius)


def test_bad_distances_are_named() -> None:
    occupied = np.zeros((3, 3), np.uint8)
    with pytest.raises(InvalidValueError, match="resolution: 0"):
        distance_field(occupied, 0.0, 1.0)
    with pytest.raises(InvalidValueError, match="max_distance_m: nan"):
        distance_field(occupied, 0.1, float("nan"))
