"""A*, Dijkstra and breadth-first search on the grid."""

import itertools

import numpy as np
import pytest

from cheapest_path import cheapest
from navette.errors import InvalidValueError
from navette.navigation.planning import breadth_first, dijkstra
from navette.navigation.planning.astar import AStar
from navette.navigation.planning.traversal import LETHAL, EdgeTable, steps_cost

FREE = EdgeTable()
SEARCHES = {
    "a_star": AStar().search,
    "dijkstra": dijkstra.search,
    "breadth_first": breadth_first.search,
}
EVERY = pytest.mark.parametrize("search", SEARCHES.values(), ids=SEARCHES)


def room(text: str) -> np.ndarray:
    rows = text.split()
    return np.array(
        [[LETHAL if c == "#" else 0 for c in row] for row in rows], np.uint8
    )


@EVERY
def test_straight_and_diagonal_paths_have_exact_costs(search) -> None:
    cost = np.zeros((8, 12), np.uint8)
    cells, units = search(cost, (1, 1), (1, 9))
    assert units == 80_000
    assert cells.tolist() == [[1, column] for column in range(1, 10)]
    cells, units = search(cost, (0, 0), (5, 5))
    assert units == 5 * 14_142
    assert cells.tolist() == [[i, i] for i in range(6)]


@EVERY
def test_diagonals_need_both_orthogonal_neighbours_free(search) -> None:
    cost = room("... .#. ...")
    cells, units = search(cost, (0, 1), (1, 2))
    assert units == 20_000, "beside the closed cell, not past its corner"
    cells, units = search(cost, (0, 0), (2, 2))
    assert units == 40_000, "around, not through the corners of the middle cell"
    assert [1, 1] not in cells.tolist()


@EVERY
def test_no_path_and_closed_ends_give_none(search) -> None:
    cost = room("..#.. ..#.. ..#..")
    assert search(cost, (0, 0), (0, 4)) is None
    assert search(cost, (0, 0), (0, 2)) is None, "closed goal"
    assert search(cost, (0, 2), (0, 0)) is None, "closed start"


@EVERY
def test_start_that_is_the_goal_is_a_path_of_one_cell(search) -> None:
    cells, units = search(np.zeros((3, 3), np.uint8), (1, 2), (1, 2))
    assert cells.tolist() == [[1, 2]]
    assert units == 0


@EVERY
def test_cells_outside_are_refused_by_name(search) -> None:
    with pytest.raises(InvalidValueError, match=r"goal cell \(3, 0\).*3 x 3"):
        search(np.zeros((3, 3), np.uint8), (0, 0), (3, 0))
    with pytest.raises(InvalidValueError, match="start cell"):
        search(np.zeros((3, 3), np.uint8), (-1, 0), (1, 0))


@pytest.mark.parametrize("name", ["a_star", "dijkstra"])
def test_an_expensive_field_is_avoided(name: str) -> None:
    cost = np.zeros((9, 15), np.uint8)
    cost[2:7, 5:10] = 252
    table = EdgeTable(weight=3.0)
    cells, units = SEARCHES[name](cost, (4, 0), (4, 14), table=table)
    assert units == steps_cost(cells, cost, table)
    assert units == cheapest(cost, (4, 0), (4, 14), table)
    assert cost[cells[:, 0], cells[:, 1]].max() == 0


def test_breadth_first_counts_moves_and_ignores_cost() -> None:
    cost = np.zeros((9, 15), np.uint8)
    cost[:, 5:10] = 200
    cells, units = breadth_first.search(
        cost, (4, 0), (4, 14), table=EdgeTable(weight=2.0)
    )
    assert len(cells) == 15
    assert units == steps_cost(cells, cost, EdgeTable(weight=2.0))


def test_results_do_not_depend_on_earlier_queries() -> None:
    rng = np.random.default_rng(4)
    used = AStar()
    for _ in range(40):
        shape = (int(rng.integers(4, 30)), int(rng.integers(4, 30)))
        cost = np.where(rng.random(shape) < 0.3, LETHAL, rng.integers(0, 200, shape))
        cost = cost.astype(np.uint8)
        ends = [tuple(int(rng.integers(n)) for n in shape) for _ in range(2)]
        table = EdgeTable(weight=float(rng.integers(0, 5)))
        first, again = (a.search(cost, *ends, table=table) for a in (used, AStar()))
        assert (first is None) == (again is None)
        if first is not None and again is not None:
            assert first[1] == again[1]
            np.testing.assert_array_equal(first[0], again[0])


def test_exhausted_stamps_are_reset(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("navette.navigation.planning.astar._LAST_STAMP", 2)
    search = AStar()
    cost = np.zeros((5, 5), np.uint8)
    for column in (4, 3, 2, 4, 1, 2):
        assert search.search(cost, (0, 0), (0, column))[1] == 10_000 * column


@pytest.mark.parametrize("seed", range(8))
def test_looking_for_an_enclosed_goal_changes_no_result(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(seed)
    cost = np.where(rng.random((40, 50)) < 0.35, LETHAL, rng.integers(0, 200, (40, 50)))
    cost = cost.astype(np.uint8)
    ends = [tuple(int(rng.integers(n)) for n in cost.shape) for _ in range(40)]
    queries = list(itertools.pairwise(ends))
    expected = [AStar().search(cost, *query) for query in queries]
    monkeypatch.setattr("navette.navigation.planning.astar._BEFORE_LOOK", 8)
    monkeypatch.setattr("navette.navigation.planning.astar._LOOK_SHARE", 1)
    for query, before in zip(queries, expected, strict=True):
        found = AStar().search(cost, *query)
        assert (found is None) == (before is None)
        if found is not None and before is not None:
            assert found[1] == before[1]
            np.testing.assert_array_equal(found[0], before[0])
    assert None in expected
    assert any(each is not None for each in expected)


def test_a_search_for_an_enclosed_goal_does_not_expand_the_whole_map() -> None:
    cost = np.zeros((1500, 1500), np.uint8)
    cost[1000:1031, 1000:1031] = LETHAL
    cost[1001:1030, 1001:1030] = 0
    search = AStar()
    assert search.search(cost, (100, 100), (1015, 1015)) is None
    assert np.count_nonzero(search._records) < 250_000


def test_field_holds_the_cost_to_the_cheapest_goal() -> None:
    cost = room("....# .##.. ....# ....#")
    field = dijkstra.cost_to_go(cost, [((0, 0), 0), ((1, 4), 25_000)], table=FREE)
    for row in range(4):
        for column in range(5):
            ways = [
                None if units is None else units + extra
                for goal, extra in (((0, 0), 0), ((1, 4), 25_000))
                for units in [cheapest(cost, (row, column), goal, FREE)]
            ]
            known = [way for way in ways if way is not None]
            expected = min(known) if known else dijkstra.UNREACHED
            assert field[row, column] == expected


def test_the_edge_table_refuses_invalid_values() -> None:
    with pytest.raises(InvalidValueError, match="weight"):
        EdgeTable(weight=-1.0)
    with pytest.raises(InvalidValueError, match="uint8"):
        AStar().search(np.zeros((3, 3), np.int32), (0, 0), (1, 1))
