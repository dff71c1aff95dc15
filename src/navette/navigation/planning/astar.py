"""A*: the cheapest 8-connected path between two cells, exact.

Hart, Nilsson and Raphael 1968, with an open list as in Dial 1969: a circle of
buckets over fixed-point f. A bucket is a last-in-first-out list of cells, so the
search dives towards the goal. Cells whose g decreases are opened again, and the search
ends when the goal's own bucket is empty, which keeps the result exact. Neighbours that
a path past the cell reaches for no more are not offered (:mod:`.pruning`).
Diagonal moves need both orthogonal neighbours free. A long search looks now and then
whether the goal is enclosed, before it expands all that can be reached.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import sparse_zeros
from navette.navigation.planning.bucket_queue import (
    WAITING,
    BucketQueue,
    has_room,
    new_pool,
    pop,
    push,
    push_next,
    reserve,
)
from navette.navigation.planning.cheap_tiles import TILE, CheapTiles
from navette.navigation.planning.connection import is_cut_off
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.pruning import (
    all_neighbours,
    steps_around,
    successors,
)
from navette.navigation.planning.traversal import (
    DIAGONAL,
    STRAIGHT,
    Cell,
    EdgeTable,
    SearchGrid,
    require_inside,
    rim_of,
)

# A record per cell: stamp << 48 | (most − g) << 4 | closed << 3 | last move. The stamp
# increases with every query, so records of earlier queries, and the zeros of a new
# array, compare as more expensive than any and need no clearing. Memory that no search
# has touched is not occupied.
_LAST_STAMP = 32_766
_G_MASK = (1 << 44) - 1
_OBLIQUE = DIAGONAL - STRAIGHT
_CLOSED = 8
_NEIGHBOURS = 8
_NEVER = 1 << 60
# Cells expanded before the first look at whether the goal is enclosed; then four times
# as many. A look at a sixteenth as many cells takes 2 % of that time.
_BEFORE_LOOK, _LOOK_SHARE, _LOOK_GROWTH = 1 << 17, 16, 4
_NOWHERE = np.zeros((1, 1), np.int32)


@PLANNERS.register("a_star")
class AStar:
    """Search that keeps its working arrays between queries.

    Attributes:
        expanded: number of cells that all queries have expanded.
    """

    def __init__(self) -> None:
        self._records = np.empty(0, np.int64)
        self._rimmed = np.empty((0, 0), np.uint8)
        self._pool = new_pool()
        self._stamp = 0
        self.expanded = 0

    def search(
        self,
        cost: NDArray[np.uint8],
        start: Cell,
        goal: Cell,
        *,
        table: EdgeTable | None = None,
        bound: float = math.inf,
        cheap: CheapTiles | None = None,
    ) -> tuple[NDArray[np.int64], int] | None:
        """Return cells (N, 2) row, column from start to goal, and the cost in units.

        Args:
            cost: (H, W) cell costs.
            start: first cell; its own cost does not count.
            goal: last cell.
            table: cost of entering a cell.
            bound: cost in units from which a path is not wanted.
            cheap: where cells cost less than elsewhere, for a better heuristic.

        Returns:
            None if no path exists below the bound, or an end is closed.
        """
        require_inside(start, cost.shape, "start")
        require_inside(goal, cost.shape, "goal")
        table = table or EdgeTable()
        grid = SearchGrid.of(cost, table, self._rimmed)
        if rim_of(cost) is None:
            self._rimmed = grid.cost.reshape(-1, grid.stride)
        if not (grid.is_open(start) and grid.is_open(goal)):
            return None
        if start == goal:
            return np.array([start], np.int64), 0
        self._prepare(grid.cost.size)
        from_units = min(int(min(bound, _NEVER)), _NEVER)
        query = _Query(
            _item_of(start),
            _item_of(goal),
            np.int64(self._stamp << 48),
            self._records,
            np.array([from_units]),
            *_elsewhere(cheap, goal, table),
            steps_around(grid.stride),
            steps_around(1 << 16),
            np.zeros((_NEIGHBOURS, 2), np.int64),
        )
        steepest = query.excess * TILE * DIAGONAL // 10_000
        queue = BucketQueue.spanning(table.longest + DIAGONAL + steepest)
        ends = grid.index_of(start), grid.index_of(goal)
        bucket, done, most = -1, False, _BEFORE_LOOK
        while not done:
            self._pool, bucket, done, left = _search(
                grid, query, queue, self._pool, bucket, most
            )
            self.expanded += most - left
            if not done and is_cut_off(grid, ends[1], ends[0], most // _LOOK_SHARE):
                return None
            most *= _LOOK_GROWTH
        total = int(query.best[0])
        if total >= from_units:
            return None
        return _trace(self._records, query.steps, grid.stride, *ends), total

    def _prepare(self, size: int) -> None:
        self._stamp += 1
        if self._records.size != size or self._stamp > _LAST_STAMP:
            self._records = sparse_zeros((size,), np.int64)
            self._stamp = 1


def _item_of(cell: Cell) -> int:
    """Return a cell as the open list stores it: row << 16 | column, rimmed."""
    return (cell[0] + 1) << 16 | (cell[1] + 1)


def _elsewhere(
    cheap: CheapTiles | None, goal: Cell, table: EdgeTable
) -> tuple[NDArray[np.int32], int]:
    """Return ``away`` and ``excess``; a goal among cheap cells needs neither."""
    if cheap is None or cheap.distances()[goal[0] // TILE, goal[1] // TILE] == 0:
        return _NOWHERE, 0
    return cheap.distances(), cheap.excess(table)


class _Query(NamedTuple):
    """Ends and bounds of a query, and the arrays of the search.

    Attributes:
        start, goal: items of the open list; see :func:`_item_of`.
        base: the query's stamp in a record.
        records: one per cell of the rimmed grid.
        best: (1,) least cost of a path so far, at first that of an unwanted one.
        away: distance of each tile from the cheap ones, in units.
        excess: what a unit of cost elsewhere costs more, in 1/10000.
        steps: (8,) what a move adds to an index.
        item_steps: (8,) what a move adds to an item.
        offers: (8, 2) neighbours to offer a path to; see :mod:`.pruning`.
    """

    start: int
    goal: int
    base: np.int64
    records: NDArray[np.int64]
    best: NDArray[np.int64]
    away: NDArray[np.int32]
    excess: int
    steps: NDArray[np.int64]
    item_steps: NDArray[np.int64]
    offers: NDArray[np.int64]


@kernel
def _search(
    grid: Any, query: Any, queue: Any, pool: Any, bucket: Any, most: int
) -> tuple[Any, int, bool, int]:
    """Lower ``best`` to the least cost of a path.

    Args:
        grid, query, queue, pool: of the search.
        bucket: as returned by the call that this one continues; negative for the first.
        most: number of cells to expand.

    Returns:
        The pool, the bucket, whether the search is done, and how many cells may follow.
    """
    if bucket < 0:
        bucket = np.int64(_to_goal(query, query.start) >> queue.shift)
        query.records[_index(grid, query.start)] = query.base | (_G_MASK << 4)
        push(pool, queue, bucket, query.start)
    done = False
    while not done and most > 0:
        pool = reserve(pool, queue, _NEIGHBOURS)
        bucket, done, most = _expand_while_room(grid, query, queue, pool, bucket, most)
    return pool, bucket, done, most


@kernel(allocates=False)
def _expand_while_room(
    grid: Any, query: Any, queue: Any, pool: Any, bucket: int, most: int
) -> tuple[int, bool, int]:
    """Expand up to ``most`` cells until the search is done, or the pool is full.

    Returns the bucket, whether the search is done, and how many cells may follow.
    """
    records, steps, offers, best = query.records, query.steps, query.offers, query.best
    while queue.state[WAITING] > 0 and bucket <= best[0] >> queue.shift:
        if most == 0 or not has_room(pool, queue, _NEIGHBOURS):
            return bucket, False, most
        item = pop(pool, queue, bucket)
        if item < 0:
            bucket += 1
            continue
        index = _index(grid, item)
        record = records[np.uint64(index)]
        if record & _CLOSED:
            continue
        records[np.uint64(index)] = record | _CLOSED
        most -= 1
        g = _G_MASK - ((record >> 4) & _G_MASK)
        if g > 0:
            count = successors(grid, steps, index, record & 7, offers)
        else:
            count = all_neighbours(grid, steps, index, offers)
        _offer(query, queue, pool, bucket, (index, item, g), count)
    return bucket, True, most


@kernel(allocates=False, forceinline=True)
def _offer(
    query: Any, queue: Any, pool: Any, bucket: int, cell: Any, count: int
) -> None:
    """Offer g + edge to the first ``count`` of ``offers``; ``cell`` is index, item, g.

    Where the heuristic falls by more than a step costs, the bound of the cell that is
    expanded also holds for its neighbours (pathmax, Mérő 1984).
    """
    index, item, g = cell
    records, best = query.records, query.best
    for i in range(count):
        move = query.offers[np.uint64(i), 0]
        g_new = g + query.offers[np.uint64(i), 1]
        reached = np.uint64(index + query.steps[np.uint64(move)])
        record = query.base | ((_G_MASK - g_new) << 4) | move
        if record <= (records[reached] | 15):
            continue
        item_new = item + query.item_steps[np.uint64(move)]
        f = g_new + _to_goal(query, item_new)
        if f >= best[0]:
            continue
        records[reached] = record
        if item_new == query.goal:
            best[0] = g_new
        elif f >> queue.shift <= bucket:
            push_next(pool, queue, bucket, item_new)
        else:
            push(pool, queue, f >> queue.shift, item_new)


@kernel(allocates=False, forceinline=True)
def _index(grid: Any, item: int) -> int:
    """Return the flat index of an item."""
    return int((item >> 16) * grid.stride + (item & 0xFFFF))


@kernel(allocates=False, forceinline=True)
def _to_goal(query: Any, item: int) -> int:
    """Return the least cost from a cell of the rimmed grid to the goal.

    A path leaves the tile of the cell towards a cheap one, and ends at the goal behind
    the last cheap one: that much of it, at least, is not cheap.
    """
    row, column = item >> 16, item & 0xFFFF
    goal_row, goal_column = query.goal >> 16, query.goal & 0xFFFF
    least = _octile(row - goal_row, column - goal_column)
    if query.excess == 0:
        return least
    away, tile = query.away, np.uint64(TILE)
    here = away[np.uint64(row - 1) // tile, np.uint64(column - 1) // tile]
    there = away[np.uint64(goal_row - 1) // tile, np.uint64(goal_column - 1) // tile]
    apart = min(least, here + there)
    return least + int(apart * query.excess // 10_000)


@kernel(allocates=False, forceinline=True)
def _octile(rows: int, columns: int) -> int:
    """Return the least cost over free cells: the heuristic."""
    rows = rows if rows >= 0 else -rows
    columns = columns if columns >= 0 else -columns
    if rows > columns:
        return STRAIGHT * rows + _OBLIQUE * columns
    return STRAIGHT * columns + _OBLIQUE * rows


@kernel
def _trace(
    records: Any, steps: Any, stride: int, start_index: int, goal_index: int
) -> Any:
    """Return cells (N, 2) of the unrimmed grid, start first."""
    count = 1
    index = goal_index
    while index != start_index:
        index -= steps[records[index] & 7]
        count += 1
    cells = np.empty((count, 2), np.int64)
    index = goal_index
    for i in range(count - 1, -1, -1):
        cells[i, 0] = index // stride - 1
        cells[i, 1] = index % stride - 1
        index -= steps[records[index] & 7]
    return cells
