"""Grids of costs with a lethal rim in memory."""

import numpy as np
import pytest

from navette.navigation.planning.astar import AStar
from navette.navigation.planning.traversal import (
    LETHAL,
    copy_costs,
    rim_of,
    rimmed_costs,
    with_rim,
)


def test_costs_with_a_rim_are_read_in_place() -> None:
    cost = rimmed_costs((3, 5), 7)
    assert cost.shape == (3, 5)
    assert (cost == 7).all()
    whole = with_rim(cost)
    assert whole is rim_of(cost)
    assert whole.shape == (5, 7)
    cost[1, 2] = 9
    assert whole[2, 3] == 9
    assert (whole[[0, -1]] == LETHAL).all()
    assert (whole[:, [0, -1]] == LETHAL).all()


def test_a_copy_has_a_rim_of_its_own() -> None:
    cost = np.arange(12, dtype=np.uint8).reshape(3, 4)
    copied = copy_costs(cost)
    assert (copied == cost).all()
    assert rim_of(copied) is not None
    copied[0, 0] = 200
    assert cost[0, 0] == 0


@pytest.mark.parametrize(
    "cost",
    [
        np.zeros((4, 4), np.uint8),  # no other array around it
        np.zeros((6, 6), np.uint8)[1:-1, 1:-1],  # a rim that is not lethal
        np.full((6, 6), LETHAL, np.uint8)[0:4, 0:4],  # not the inner part
        np.full((6, 6), LETHAL, np.uint8)[1:-1, 1:-1][::-1],
        np.full((6, 8), LETHAL, np.uint8).T[1:-1, 1:-1],
    ],
)
def test_other_costs_are_copied(cost: np.ndarray) -> None:
    assert rim_of(cost) is None
    whole = with_rim(cost)
    assert not np.shares_memory(whole, cost)
    assert (whole[1:-1, 1:-1] == cost).all()


def test_a_search_of_other_costs_leaves_a_rimmed_grid_as_it_was() -> None:
    astar = AStar()
    mine = rimmed_costs((6, 6), 3)
    assert astar.search(mine, (0, 0), (5, 5)) is not None
    assert astar.search(np.zeros((6, 6), np.uint8), (0, 0), (5, 5)) is not None
    assert (mine == 3).all()
