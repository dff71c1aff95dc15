"""A*: the cheapest 8-connected path between two cells, exact.

Hart, Nilsson and Raphael 1968, with an open list as in Dial 1969: a circle of
buckets over fixed-point f. A bucket is a last-in-first-out list of cells, so the
search dives towards the goal. Cells whose g decreases are opened again, and the search
ends when the goal's own bucket is empty, which keeps the result exact.
Diagonal moves need both orthogonal neighbours free.
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
    reserve,
)
from navette.navigation.planning.cheap_tiles import TILE, CheapTiles
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.traversal import (
    DIAGONAL,
    STRAIGHT,
    Cell,
    EdgeTable,
    SearchGrid,
    require_inside,
    rim_of,
)

# A record per cell: stamp << 48 | (most − g) << 4 | closed << 3 | direction. The stamp
# increases with every query, so records of earlier queries, and the zeros of a new
# array, compare as more expensive than any and need no clearing. Memory that no search
# has touched is not occupied.
_LAST_STAMP = 32_766
_G_MASK = (1 << 44) - 1
_OBLIQUE = DIAGONAL - STRAIGHT
_CLOSED = 8
_NEIGHBOURS = 8
_NEVER = 1 << 60
_NOWHERE = np.zeros((1, 1), np.int64)


@PLANNERS.register("a_star")
class AStar:
    """Search that keeps its working arrays between queries."""

    def __init__(self) -> None:
        self._records = np.empty(0, np.int64)
        self._rimmed = np.empty((0, 0), np.uint8)
        self._pool = new_pool()
        self._stamp = 0

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
        query = _Query(
            start[0] + 1,
            start[1] + 1,
            goal[0] + 1,
            goal[1] + 1,
            np.int64(self._stamp << 48),
            self._records,
            min(int(min(bound, _NEVER)), _NEVER),
            *_elsewhere(cheap, goal, table),
        )
        steepest = query.excess * TILE * DIAGONAL // 10_000
        queue = BucketQueue.spanning(table.longest + DIAGONAL + steepest)
        total, self._pool = _search(grid, query, queue, self._pool)
        if total < 0:
            return None
        ends = grid.index_of(start), grid.index_of(goal)
        return _trace(self._records, grid.stride, *ends), total

    def _prepare(self, size: int) -> None:
        self._stamp += 1
        if self._records.size != size or self._stamp > _LAST_STAMP:
            self._records = sparse_zeros((size,), np.int64)
            self._stamp = 1


def _elsewhere(
    cheap: CheapTiles | None, goal: Cell, table: EdgeTable
) -> tuple[NDArray[np.int64], int]:
    """Return ``away`` and ``excess``; a goal among cheap cells needs neither."""
    if cheap is None or cheap.distances()[goal[0] // TILE, goal[1] // TILE] == 0:
        return _NOWHERE, 0
    return cheap.distances(), cheap.excess(table)


class _Query(NamedTuple):
    """Ends in the rimmed grid, the query's stamp in a record, and the records.

    ``bound``: cost from which a path is not wanted. ``away``: distance of each tile
    from the cheap ones, in units; ``excess``: what a unit of cost elsewhere costs more,
    in 1/10000.
    """

    start_row: int
    start_column: int
    goal_row: int
    goal_column: int
    base: np.int64
    records: NDArray[np.int64]
    bound: int
    away: NDArray[np.int64]
    excess: int


@kernel
def _search(grid: Any, query: Any, queue: Any, pool: Any) -> Any:
    """Search the grid; return (g of the goal or −1, the pool).

    An open item is row << 16 | column.
    """
    row, column = query.start_row, query.start_column
    bucket = _to_goal(query, row, column) >> queue.shift
    query.records[row * grid.stride + column] = query.base | (_G_MASK << 4)
    push(pool, queue, bucket, (row << 16) | column)
    best: Any = np.int64(query.bound)
    found, done = False, False
    while not done:
        pool = reserve(pool, queue, _NEIGHBOURS)
        bucket, best, found, done = _expand_while_room(
            grid, query, queue, pool, bucket, best, found
        )
    return (best if found else np.int64(-1)), pool


@kernel(allocates=False)
def _expand_while_room(
    grid: Any, query: Any, queue: Any, pool: Any, bucket: Any, best: Any, found: bool
) -> tuple[int, int, bool, bool]:
    """Expand cells until the search is done, or the pool is full.

    Returns the bucket, g of the goal, whether it was reached, whether that is final.
    """
    stride, records, shift = grid.stride, query.records, queue.shift
    while queue.state[WAITING] > 0 and bucket <= best >> shift:
        if not has_room(pool, queue, _NEIGHBOURS):
            return bucket, best, found, False
        item = pop(pool, queue, bucket)
        if item < 0:
            bucket += 1
            continue
        row, column = item >> 16, item & 0xFFFF
        index = np.uint64(row * stride + column)
        record = records[index]
        if record & _CLOSED:
            continue
        records[index] = record | _CLOSED
        g = _G_MASK - ((record >> 4) & _G_MASK)
        behind = _behind(record & 7) if g > 0 else 0  # the start: none
        least = _expand(grid, query, queue, pool, bucket, row, column, g, behind, best)
        found |= least < best
        best = least
    return bucket, best, found, True


@kernel(allocates=False, forceinline=True)
def _behind(move: int) -> int:
    """Return the neighbours behind a cell that ``move`` reached: a bit for each move.

    The cell before reaches them directly, and for less, whatever the cells cost.
    """
    return (0xC2, 0x31, 0xA8, 0x54, 0x8A, 0x46, 0x29, 0x15)[move]


@kernel(allocates=False, forceinline=True)
def _expand(
    grid: Any,
    query: Any,
    queue: Any,
    pool: Any,
    bucket: int,
    row: int,
    column: int,
    g: int,
    behind: int,
    best: int,
) -> int:
    """Offer g + edge to the neighbours that are not ``behind``; return the goal's g.

    Where the heuristic falls by more than a step costs, the bound of the cell that is
    expanded also holds for its neighbours (pathmax, Mérő 1984).
    """
    cost, stride, straight, diagonal = grid
    records, base = query.records, query.base
    steps = (-stride, stride, -1, 1, -stride - 1, -stride + 1, stride - 1, stride + 1)
    rows = (-1, 1, 0, 0, -1, -1, 1, 1)
    columns = (0, 0, -1, 1, -1, 1, -1, 1)
    index = row * stride + column
    orthogonal = (
        straight[cost[np.uint64(index - stride)]],
        straight[cost[np.uint64(index + stride)]],
        straight[cost[np.uint64(index - 1)]],
        straight[cost[np.uint64(index + 1)]],
    )
    for k in range(8):
        if behind >> k & 1:
            continue
        reached = np.uint64(index + steps[k])
        if k < 4:
            edge = orthogonal[k]
        elif orthogonal[(k - 4) >> 1] == 0 or orthogonal[2 + (k & 1)] == 0:
            continue
        else:
            edge = diagonal[cost[reached]]
        candidate = base | ((_G_MASK - g - edge) << 4) | k
        if edge == 0 or candidate <= (records[reached] | 15):
            continue
        row_new, column_new = row + rows[k], column + columns[k]
        f = g + edge + _to_goal(query, row_new, column_new)
        if f >= best:
            continue
        records[reached] = candidate
        if row_new == query.goal_row and column_new == query.goal_column:
            best = g + edge
        else:
            at = max(bucket, f >> queue.shift)
            push(pool, queue, at, (row_new << 16) | column_new)
    return best


@kernel(allocates=False, forceinline=True)
def _to_goal(query: Any, row: int, column: int) -> int:
    """Return the least cost from a cell of the rimmed grid to the goal.

    A path leaves the tile of the cell towards a cheap one, and ends at the goal behind
    the last cheap one: that much of it, at least, is not cheap.
    """
    least = _octile(row - query.goal_row, column - query.goal_column)
    if query.excess == 0:
        return least
    away, tile = query.away, np.uint64(TILE)
    here = away[np.uint64(row - 1) // tile, np.uint64(column - 1) // tile]
    there = away[
        np.uint64(query.goal_row - 1) // tile, np.uint64(query.goal_column - 1) // tile
    ]
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
def _trace(records: Any, stride: int, start_index: int, goal_index: int) -> Any:
    """Return cells (N, 2) of the unrimmed grid, start first."""
    steps = (-stride, stride, -1, 1, -stride - 1, -stride + 1, stride - 1, stride + 1)
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
