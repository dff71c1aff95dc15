"""Levels of distances, beside the field in metres."""

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.navigation.grids import (
    CellWindow,
    DistanceLevels,
    distance_field,
    distance_levels,
    level_metres,
)
from navette.navigation.grids.distance_levels import parts_near, update_levels


@pytest.mark.parametrize(("reach_m", "dtype"), [(0.5, np.uint16), (26.0, np.uint32)])
def test_levels_are_the_distances_of_the_field(reach_m: float, dtype: type) -> None:
    rng = np.random.default_rng(4)
    metres = level_metres(0.1, reach_m)
    for shape in ((40, 70), (3, 4), (1, 300)):
        occupied = (rng.random(shape) < 0.004).astype(np.uint8)
        level = distance_levels(occupied, metres)
        assert level.dtype == dtype
        field = distance_field(occupied, 0.1, reach_m)
        np.testing.assert_array_equal(DistanceLevels(level, metres).everywhere(), field)
        assert (level[field < np.float32(reach_m)] > 0).all()


def test_without_obstacles_all_levels_are_zero() -> None:
    metres = level_metres(0.1, 3.0)
    assert not distance_levels(np.zeros((9, 9), np.uint8), metres).any()
    assert metres[0] == np.float32(3.0)
    assert metres[-1] == 0.0


def test_a_reach_of_too_many_cells_is_named() -> None:
    with pytest.raises(InvalidValueError, match="at most 2000 cells"):
        level_metres(0.01, 100.0)


@pytest.mark.parametrize("seed", range(8))
def test_distances_near_changed_cells_give_the_levels_of_all_obstacles(seed) -> None:
    rng = np.random.default_rng(seed)
    shape, reach = (rng.integers(5, 60), rng.integers(5, 400)), int(rng.integers(1, 25))
    occupied = (rng.random(shape) < 0.01).astype(np.uint8)
    metres = level_metres(0.1, 0.1 * reach)
    level = distance_levels(occupied, metres)
    for _ in range(5):
        cells = rng.integers(0, shape, (rng.integers(1, 6), 2))
        occupied[cells[:, 0], cells[:, 1]] ^= 1
        window = CellWindow.of_cells(cells).grown(reach + 1, shape)
        parts = parts_near(cells, reach + 1, shape)
        update_levels(level, occupied, metres, window, parts)
        assert (level == distance_levels(occupied, metres)).all()
