"""Neighbours that A* leaves out, and what that must not change."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from navette.navigation.planning import dijkstra
from navette.navigation.planning.astar import AStar
from navette.navigation.planning.pruning import steps_around, successors
from navette.navigation.planning.traversal import (
    LETHAL,
    EdgeTable,
    SearchGrid,
    steps_cost,
)

NORTH, NORTH_EAST, EAST, SOUTH_EAST, SOUTH, SOUTH_WEST, WEST, NORTH_WEST = range(8)
TABLE = EdgeTable(weight=4.0)


def offered(cost: list[list[int]], move: int) -> list[int]:
    """Return the moves that remain in the middle of 3 x 3 cells."""
    grid = SearchGrid.of(np.array(cost, np.uint8), TABLE)
    offers = np.zeros((8, 2), np.int64)
    index = grid.index_of((1, 1))
    count = successors(grid, steps_around(grid.stride), index, move, offers)
    return sorted(offers[:count, 0].tolist())


@pytest.mark.parametrize("level", [0, 100])
def test_equal_costs_leave_the_natural_neighbours_of_jump_point_search(
    level: int,
) -> None:
    cost = [[level] * 3] * 3
    for move in (NORTH, EAST, SOUTH, WEST):
        assert offered(cost, move) == [move]
    assert offered(cost, NORTH_EAST) == [NORTH, NORTH_EAST, EAST]
    assert offered(cost, SOUTH_WEST) == [SOUTH, SOUTH_WEST, WEST]
    assert offered(cost, NORTH_WEST) == [NORTH, WEST, NORTH_WEST]


def test_a_closed_cell_forces_the_neighbours_that_it_kept_from_its_neighbour() -> None:
    # The path entered (1, 1) from (1, 0), which has no diagonal move past (0, 0).
    cost = [[LETHAL, 0, 0], [0, 0, 0], [0, 0, 0]]
    assert offered(cost, EAST) == [NORTH, NORTH_EAST, EAST]


def test_a_diagonal_move_after_a_straight_one_remains_where_it_costs_less() -> None:
    # The other order enters (0, 1), which costs more than the cell itself.
    assert offered([[0, 50, 0], [0, 0, 0], [0, 0, 0]], EAST) == [NORTH_EAST, EAST]
    assert offered([[0, 0, 0], [0, 200, 0], [0, 0, 0]], EAST) == [EAST]


def test_a_straight_move_after_a_diagonal_one_is_left_out_where_it_costs_more() -> None:
    # From (2, 0): by way of (2, 1) or (1, 0), past the expensive cell in the middle.
    assert offered([[0, 0, 0], [0, 200, 0], [0, 0, 0]], NORTH_EAST) == [NORTH_EAST]


def some_cost(rng: np.random.Generator, kind: str) -> np.ndarray:
    shape = tuple(rng.integers(2, 30, 2))
    if kind == "few levels":
        cost = rng.integers(0, 3, shape) * 60
    elif kind == "noise":
        cost = rng.integers(0, 253, shape)
    else:
        smooth = gaussian_filter(rng.random(shape), 3.0)
        cost = 252 * (smooth - smooth.min()) / (np.ptp(smooth) + 1e-9)
    closed = rng.random(shape) < rng.choice([0.0, 0.1, 0.35])
    return np.where(closed, LETHAL, cost).astype(np.uint8)


@pytest.mark.parametrize("kind", ["few levels", "noise", "smooth"])
def test_paths_cost_as_much_as_those_of_dijkstra_which_offers_everything(
    kind: str,
) -> None:
    rng = np.random.default_rng(8)
    search = AStar().search
    for _ in range(300):
        cost = some_cost(rng, kind)
        table = EdgeTable(weight=float(rng.choice([0.0, 0.3, 4.0, 1000.0])))
        ends = [tuple(int(rng.integers(n)) for n in cost.shape) for _ in range(2)]
        found = search(cost, *ends, table=table)
        expected = dijkstra.search(cost, *ends, table=table)
        assert (found is None) == (expected is None)
        if found is not None and expected is not None:
            assert found[1] == expected[1] == steps_cost(found[0], cost, table)
