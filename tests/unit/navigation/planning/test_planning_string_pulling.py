"""String pulling: short, valid, not more expensive; as good as Theta*."""

import heapq
import math

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.navigation.planning.astar import AStar
from navette.navigation.planning.string_pulling import centers, pull
from navette.navigation.planning.traversal import LETHAL, EdgeTable
from polyline_cost import line_cost

Cell = tuple[int, int]


def length(line: np.ndarray) -> float:
    steps = np.diff(line, axis=0)
    return float(np.hypot(steps[:, 0], steps[:, 1]).sum())


def rectangles(seed: int, size: int = 80, share: float = 0.25) -> np.ndarray:
    rng = np.random.default_rng(seed)
    cost = np.zeros((size, size), np.uint8)
    while (cost > 0).mean() < share:
        row, column = rng.integers(0, size, 2)
        height, width = rng.integers(2, size // 8, 2)
        cost[row : row + height, column : column + width] = LETHAL
    return cost


def far_apart(cost: np.ndarray, seed: int, count: int) -> list[tuple[Cell, Cell]]:
    rng = np.random.default_rng(seed)
    free = np.argwhere(cost < LETHAL)
    pairs = []
    while len(pairs) < count:
        a, b = free[rng.integers(0, len(free), 2)]
        if np.hypot(*(a - b)) > 0.6 * len(cost):
            pairs.append((tuple(a.tolist()), tuple(b.tolist())))
    return pairs


def theta_star(cost: np.ndarray, start: Cell, goal: Cell) -> float:
    """Length of the path of Theta* (Nash et al. 2007), in plain Python."""

    def sees(a: Cell, b: Cell) -> bool:
        return math.isfinite(line_cost(cost, centers(np.array([a, b]))))

    best, parent = {start: 0.0}, {start: start}
    waiting = [(math.dist(start, goal), start)]
    done = set()
    while waiting:
        _, cell = heapq.heappop(waiting)
        if cell == goal:
            return best[goal]
        if cell in done:
            continue
        done.add(cell)
        for dr in (-1, 0, 1):
            for dc in (-1, 0, 1):
                to = (cell[0] + dr, cell[1] + dc)
                inside = all(0 <= to[i] < cost.shape[i] for i in (0, 1))
                if to == cell or not inside or cost[to] or to in done:
                    continue
                if cost[to[0], cell[1]] or cost[cell[0], to[1]]:
                    continue
                via = parent[cell] if sees(parent[cell], to) else cell
                g = best[via] + math.dist(via, to)
                if g < best.get(to, math.inf):
                    best[to], parent[to] = g, via
                    heapq.heappush(waiting, (g + math.dist(to, goal), to))
    raise AssertionError("no path")


def test_free_space_gives_the_straight_line() -> None:
    cost = np.zeros((20, 30), np.uint8)
    cells, _ = AStar().search(cost, (2, 3), (17, 26))
    line = pull(cost, centers(cells))
    np.testing.assert_allclose(line, [[3.5, 2.5], [26.5, 17.5]])


def test_the_ends_are_kept() -> None:
    cost = rectangles(1)
    start, goal = far_apart(cost, 2, 1)[0]
    points = centers(AStar().search(cost, start, goal)[0])
    points[0] += (0.3, -0.4)
    points[-1] += (-0.2, 0.1)
    line = pull(cost, points)
    np.testing.assert_allclose(line[[0, -1]], points[[0, -1]])


def test_no_segment_cuts_a_corner() -> None:
    cost = np.zeros((10, 10), np.uint8)
    cost[4, 4] = cost[5, 5] = LETHAL  # the diagonal gap between them is closed
    assert math.isinf(line_cost(cost, np.array([[3.5, 6.5], [6.5, 3.5]])))
    cells, _ = AStar().search(cost, (6, 3), (3, 6))
    assert math.isfinite(line_cost(cost, pull(cost, centers(cells))))


def test_cost_is_integrated_through_the_cells_crossed() -> None:
    cost = np.zeros((4, 10), np.uint8)
    cost[:, 5:] = 126
    table = EdgeTable(weight=2.0)
    line = np.array([[1.0, 2.0], [9.0, 2.0]])
    assert line_cost(cost, line, table=table) == pytest.approx(4 * 1 + 4 * 2)
    bent = np.array([[1.0, 1.0], [5.0, 3.0], [9.0, 3.0]])
    expected = math.hypot(4, 2) + 4 * 2
    assert line_cost(cost, bent, table=table) == pytest.approx(expected)


def test_an_expensive_field_is_not_crossed() -> None:
    cost = np.zeros((30, 60), np.uint8)
    cost[5:25, 20:40] = 252
    table = EdgeTable(weight=5.0)
    cells, _ = AStar().search(cost, (15, 2), (15, 57), table=table)
    before = centers(cells)
    line = pull(cost, before, table=table)
    assert line_cost(cost, line, table=table) < line_cost(cost, before, table=table)
    assert length(line) == pytest.approx(line_cost(cost, line, table=table))


@pytest.mark.slow
def test_lengths_are_within_a_hundredth_of_theta_star() -> None:
    ratios = []
    for seed in (3, 4, 5):
        cost = rectangles(seed)
        for start, goal in far_apart(cost, seed, 3):
            found = AStar().search(cost, start, goal)
            if found is not None:
                pulled = length(pull(cost, centers(found[0])))
                ratios.append(pulled / theta_star(cost, start, goal))
    assert len(ratios) > 5
    assert np.mean(ratios) < 1.01
    assert max(ratios) < 1.03, "single queries may keep to another side"


def test_points_outside_are_refused() -> None:
    with pytest.raises(InvalidValueError, match=r"4 x 4.*inside"):
        pull(np.zeros((4, 4), np.uint8), np.array([[0.5, 0.5], [4.5, 0.5]]))
