"""The distance field of the predictive controller."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.navigation.control.local_field import local_field, open_field

EXACT_M = 0.35


def centres(shape: tuple[int, ...], x: float, y: float, edge: float) -> np.ndarray:
    rows, columns = np.indices(shape)
    return np.stack((x + (columns + 0.5) * edge, y + (rows + 0.5) * edge), axis=-1)


@settings(max_examples=60, deadline=None)
@given(
    count=st.integers(1, 30),
    seed=st.integers(0, 1000),
    edge=st.sampled_from([0.02, 0.05, 0.1]),
)
def test_near_obstacles_the_distance_is_exact(
    count: int, seed: int, edge: float
) -> None:
    points = np.random.default_rng(seed).uniform(-2, 2, (count, 2))
    points += np.array((500.0, -90.0))
    field = local_field(points, edge, 1.0)
    cells = centres(field.distance_m.shape, field.x, field.y, edge)
    gaps = np.hypot(*(cells[..., None, :] - points).transpose(3, 0, 1, 2))
    exact = gaps.min(axis=-1)
    near = exact < EXACT_M
    np.testing.assert_allclose(field.distance_m[near], exact[near], atol=1e-5)
    assert (field.distance_m[~near] >= EXACT_M - 1e-6).all()
    off = np.abs(field.distance_m - np.minimum(exact, 1.0))
    assert off.max() <= edge, "elsewhere the error is below a cell"


def test_the_border_is_far_from_all_obstacles() -> None:
    distance = local_field(np.array([[1.0, 2.0]]), 0.05, 1.0).distance_m
    border = np.concatenate([distance[0], distance[-1], *distance[:, [0, -1]].T])
    assert border.min() >= 0.95


def test_without_obstacles_everything_is_far() -> None:
    assert local_field(np.empty((0, 2)), 0.05, 1.0).distance_m.min() > 100.0
    assert open_field().distance_m.min() > 100.0


def test_half_an_obstacle_cell_is_kept() -> None:
    field = local_field(np.zeros((1, 2)), 0.05, 1.0, 0.025)
    assert field.half_cell_m == pytest.approx(0.025)
