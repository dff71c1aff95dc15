"""On any small grid the searches find the cheapest valid path."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from cheapest_path import cheapest
from navette.navigation.planning import breadth_first, dijkstra
from navette.navigation.planning.astar import AStar
from navette.navigation.planning.connection import first_connected
from navette.navigation.planning.string_pulling import centers, pull
from navette.navigation.planning.traversal import (
    LETHAL,
    EdgeTable,
    steps_cost,
)
from polyline_cost import line_cost

Cell = tuple[int, int]
COSTS = st.one_of(st.just(0), st.just(LETHAL), st.integers(0, LETHAL))
GRIDS = st.tuples(st.integers(1, 9), st.integers(1, 9)).flatmap(
    lambda shape: arrays.arrays(np.uint8, shape, elements=COSTS)
)
WEIGHTS = st.sampled_from([0.0, 0.7, 3.0, 40.0])
ASTAR = AStar()


@given(GRIDS, st.data(), WEIGHTS)
def test_astar_and_dijkstra_find_the_cheapest_path(
    cost: np.ndarray, data: st.DataObject, weight: float
) -> None:
    start, goal = (ends(data, cost.shape) for _ in range(2))
    table = EdgeTable(weight=weight)
    expected = cheapest(cost, start, goal, table)
    for search in (ASTAR.search, dijkstra.search):
        found = search(cost, start, goal, table=table)
        if expected is None:
            assert found is None
            continue
        assert found is not None
        cells, units = found
        assert units == expected == steps_cost(cells, cost, table)
        check_legal(cells, cost, start, goal)


@given(GRIDS, st.data())
def test_breadth_first_finds_the_fewest_moves(
    cost: np.ndarray, data: st.DataObject
) -> None:
    start, goal = (ends(data, cost.shape) for _ in range(2))
    found = breadth_first.search(cost, start, goal)
    best = ASTAR.search(cost, start, goal)
    assert (found is None) == (best is None)
    if found is not None and best is not None:
        check_legal(found[0], cost, start, goal)
        assert len(found[0]) <= len(best[0])


@given(GRIDS, st.data())
def test_the_first_connected_cell_is_the_first_reachable_one(
    cost: np.ndarray, data: st.DataObject
) -> None:
    start, table = ends(data, cost.shape), EdgeTable()
    cells = np.array([ends(data, cost.shape) for _ in range(4)])
    field = dijkstra.cost_to_go(cost, [(start, 0)], table=table)
    reached = field[tuple(cells.T)] < dijkstra.UNREACHED
    expected = int(reached.argmax()) if reached.any() else None
    assert first_connected(cost, start, cells, table) == expected


@given(GRIDS, st.data(), WEIGHTS, st.sampled_from([0, 12_000, 50_000, 1 << 40]))
def test_a_guide_has_the_cost_of_every_cell_on_a_good_way(
    cost: np.ndarray, data: st.DataObject, weight: float, beyond: int
) -> None:
    start, goal, other = (ends(data, cost.shape) for _ in range(3))
    table = EdgeTable(weight=weight)
    goals = [(goal, 0), (other, 30_000)]
    field = dijkstra.cost_to_go(cost, goals, table=table)
    guide = dijkstra.guide_to(cost, goals, table=table, start=start, beyond=beyond)
    for cell in np.ndindex(cost.shape):
        found = dijkstra.to_go(guide, *cell)
        if table.straight[cost[cell]] == 0:
            assert found == dijkstra.UNREACHED
            continue
        rows, columns = np.abs(np.subtract(cell, start))
        least = 10_000 * abs(rows - columns) + 14_142 * min(rows, columns)
        if field[cell] + least <= field[start] + beyond:
            assert found == field[cell]
        else:
            assert found in (field[cell], guide.limit)
            assert guide.met or found == field[cell]


@given(GRIDS, st.data(), WEIGHTS)
def test_pulled_lines_are_valid_and_not_more_expensive(
    cost: np.ndarray, data: st.DataObject, weight: float
) -> None:
    start, goal = (ends(data, cost.shape) for _ in range(2))
    table = EdgeTable(weight=weight)
    found = ASTAR.search(cost, start, goal, table=table)
    if found is None:
        return
    before = centers(found[0])
    line = pull(cost, before, table=table)
    allowed = line_cost(cost, before, table=table) * (1 + 1e-6)
    assert line_cost(cost, line, table=table) <= allowed + 1e-9
    np.testing.assert_allclose(line[[0, -1]], before[[0, -1]])


def ends(data: st.DataObject, shape: tuple[int, ...]) -> Cell:
    return (
        data.draw(st.integers(0, shape[0] - 1)),
        data.draw(st.integers(0, shape[1] - 1)),
    )


def check_legal(cells: np.ndarray, cost: np.ndarray, start: Cell, goal: Cell) -> None:
    assert tuple(cells[0]) == start
    assert tuple(cells[-1]) == goal
    assert (cost[cells[:, 0], cells[:, 1]] < LETHAL).all()
    steps = np.diff(cells, axis=0)
    assert (np.abs(steps).max(axis=1) == 1).all()
    beside = cost[cells[:-1, 0] + steps[:, 0], cells[:-1, 1]]
    across = cost[cells[:-1, 0], cells[:-1, 1] + steps[:, 1]]
    assert (beside < LETHAL).all()
    assert (across < LETHAL).all()
