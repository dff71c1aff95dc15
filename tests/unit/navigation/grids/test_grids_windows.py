"""Windows of a grid."""

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import NO_CELLS, CellWindow, GridSpec


@pytest.mark.parametrize("seed", range(20))
def test_the_window_of_known_cells_is_the_smallest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells = np.full(rng.integers(1, 80, 2), -1, np.int8)
    known = rng.integers(0, cells.shape, (rng.integers(0, 6), 2))
    cells[tuple(known.T)] = rng.choice([0, 40, 100])
    window = CellWindow.of_known(cells)
    assert window == CellWindow.of_cells(np.argwhere(cells != -1))
    assert (window == NO_CELLS) == (len(known) == 0)


def test_the_window_around_points_holds_their_cells() -> None:
    rng = np.random.default_rng(1)
    spec = GridSpec(0.1, 60, 40, Pose2(-1.0, -2.0, 0.3))
    points = spec.origin.apply(rng.uniform((0, 0), (6, 4), (5, 2)))
    cells = np.array([spec.cell_of(x, y) for x, y in points.tolist()])
    assert CellWindow.around(spec, points) == CellWindow.of_cells(cells)
    grown = CellWindow.of_cells(cells).grown(3, spec.shape)
    assert CellWindow.around(spec, points, 3) == grown
