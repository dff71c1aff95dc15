"""The tighter heuristic through unknown space leaves searches exact."""

import numpy as np
import pytest
from numpy.typing import NDArray

from navette.navigation.grids import CellWindow
from navette.navigation.planning.astar import AStar
from navette.navigation.planning.cheap_tiles import CheapTiles
from navette.navigation.planning.dijkstra import cost_to_go
from navette.navigation.planning.traversal import LETHAL, EdgeTable

FLOOR = 21


def partly_known(rng: np.random.Generator, shape: tuple[int, int]) -> NDArray[np.uint8]:
    """Unknown space at the floor's cost, with known patches, costs and obstacles."""
    cost = np.full(shape, FLOOR, np.uint8)
    for _ in range(rng.integers(1, 5)):
        row, column = rng.integers(0, shape[0]), rng.integers(0, shape[1])
        cost[row : row + 40, column : column + 30] = rng.integers(0, FLOOR)
    cost[rng.random(shape) < 0.05] = 120
    cost[rng.random(shape) < rng.choice([0.0, 0.1, 0.3])] = LETHAL
    return cost


@pytest.mark.parametrize("seed", range(60))
def test_the_path_costs_as_much_as_that_of_a_full_search(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shape = (int(rng.integers(20, 120)), int(rng.integers(20, 150)))
    cost = partly_known(rng, shape)
    start, goal = ((int(rng.integers(n)), int(rng.integers(m)))
                   for n, m in (shape, shape))  # fmt: skip
    cost[start] = cost[goal] = FLOOR
    table = EdgeTable(weight=float(rng.choice([3.0, 50.0])))
    expected = int(cost_to_go(cost, [(goal, 0)], table=table)[start])
    search, cheap = AStar(), CheapTiles(cost, FLOOR, CellWindow.whole(cost.shape))
    found = search.search(cost, start, goal, table=table, cheap=cheap)
    assert (None if expected >= 1 << 60 else expected) == (found and found[1])
    if found is None:
        return
    # A bound above the cost changes nothing; one below it ends the search.
    again = search.search(
        cost, start, goal, table=table, cheap=cheap, bound=found[1] + 1
    )
    assert again is not None
    assert again[1] == found[1]
    assert start == goal or (
        search.search(cost, start, goal, table=table, cheap=cheap, bound=found[1])
        is None
    )


@pytest.mark.parametrize("seed", range(10))
def test_distances_never_exceed_those_to_the_nearest_cheap_cell(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cost = partly_known(rng, (260, 200))
    cheap = CheapTiles(cost, FLOOR, CellWindow.whole(cost.shape))
    nearest = cost_to_go(
        np.zeros_like(cost),
        [((int(r), int(c)), 0) for r, c in np.argwhere(cost < FLOOR)],
        table=EdgeTable(),
    )
    least = cheap.distances().repeat(8, axis=0).repeat(8, axis=1)[:260, :200]
    assert (least <= nearest).all()
    assert least.max() > 0


def test_tiles_follow_the_costs() -> None:
    rng = np.random.default_rng(3)
    cost = partly_known(rng, (90, 61))
    cheap = CheapTiles(cost, FLOOR, CellWindow.whole(cost.shape))
    for _ in range(20):
        row, column = rng.integers(0, 80), rng.integers(0, 50)
        window = CellWindow(row, row + 9, column, column + 11)
        cost[window.slices] = rng.choice(np.array([0, FLOOR, LETHAL], np.uint8))
        cheap.update(cost, window)
        fresh = CheapTiles(cost, FLOOR, CellWindow.whole(cost.shape))
        np.testing.assert_array_equal(cheap.distances(), fresh.distances())
