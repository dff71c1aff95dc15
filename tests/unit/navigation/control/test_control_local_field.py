"""The distance field of the predictive controller."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.navigation.control.local_field import local_field, open_field
from navette.navigation.control.rollouts import LocalField

REACH_M = 1.0


def centres(shape: tuple[int, ...], x: float, y: float, edge: float) -> np.ndarray:
    rows, columns = np.indices(shape)
    return np.stack((x + (columns + 0.5) * edge, y + (rows + 0.5) * edge), axis=-1)


def distances(field: LocalField, points: np.ndarray) -> np.ndarray:
    """Distances from the centres of the cells, measured one by one."""
    cells = centres(field.distance_m.shape, field.x, field.y, field.resolution)
    gaps = np.hypot(*(cells[..., None, :] - points).transpose(3, 0, 1, 2))
    return np.asarray(gaps.min(axis=-1))


@settings(max_examples=60, deadline=None)
@given(
    count=st.integers(1, 30),
    seed=st.integers(0, 1000),
    edge=st.sampled_from([0.02, 0.05, 0.1]),
)
def test_distances_are_exact_up_to_the_reach(
    count: int, seed: int, edge: float
) -> None:
    points = np.random.default_rng(seed).uniform(-2, 2, (count, 2))
    points += np.array((500.0, -90.0))
    field = local_field(points, edge, REACH_M)
    true_m = np.minimum(distances(field, points), REACH_M)
    np.testing.assert_allclose(field.distance_m, true_m, atol=1e-5)


def test_the_border_is_beyond_the_reach_of_all_obstacles() -> None:
    points = np.array([[1.0, 2.0], [3.31, -0.77]])
    for edge in (0.02, 0.05, 0.0625):
        true_m = distances(local_field(points, edge, REACH_M), points)
        border = np.concatenate([true_m[0], true_m[-1], *true_m[:, [0, -1]].T])
        assert border.min() >= REACH_M


def test_without_obstacles_everything_is_far() -> None:
    assert local_field(np.empty((0, 2)), 0.05, 1.0).distance_m.min() > 100.0
    assert open_field().distance_m.min() > 100.0


def test_half_an_obstacle_cell_is_kept() -> None:
    field = local_field(np.zeros((1, 2)), 0.05, 1.0, 0.025)
    assert field.half_cell_m == pytest.approx(0.025)
