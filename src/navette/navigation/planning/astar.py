"""A*: the cheapest 8-connected path between two cells, exact.

Hart, Nilsson and Raphael 1968, with an open list as in Dial 1969: a circle of
buckets over fixed-point f. A bucket is a last-in-first-out list of cells, so the
search dives towards the goal. Cells whose g decreases are opened again, and the search
ends when the goal's own bucket is empty, which keeps the result exact.
Diagonal moves need both orthogonal neighbours free.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.planning.bucket_queue import (
    WAITING,
    BucketQueue,
    new_pool,
    pop,
    push,
    reserve,
)
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.traversal import (
    DIAGONAL,
    STRAIGHT,
    Cell,
    EdgeTable,
    SearchGrid,
    require_inside,
)

# A record per cell: stamp << 48 | g << 4 | closed << 3 | direction. The stamp decreases
# with every query, so records of earlier queries compare as more expensive than any
# and need no clearing.
_FIRST_STAMP = 32_766
_G_MASK = (1 << 44) - 1
_OBLIQUE = DIAGONAL - STRAIGHT
_CLOSED = 8
_NEVER = 1 << 60


@PLANNERS.register("a_star")
class AStar:
    """Search that keeps its working arrays between queries."""

    def __init__(self) -> None:
        self._records = np.empty(0, np.int64)
        self._pool = new_pool()
        self._stamp = _FIRST_STAMP

    def search(
        self,
        cost: NDArray[np.uint8],
        start: Cell,
        goal: Cell,
        *,
        table: EdgeTable | None = None,
    ) -> tuple[NDArray[np.int64], int] | None:
        """Return cells (N, 2) row, column from start to goal, and the cost in units.

        Args:
            cost: (H, W) cell costs.
            start: first cell; its own cost does not count.
            goal: last cell.
            table: cost of entering a cell.

        Returns:
            None if no path exists, or an end is closed.
        """
        require_inside(start, cost.shape, "start")
        require_inside(goal, cost.shape, "goal")
        table = table or EdgeTable()
        grid = SearchGrid.of(cost, table)
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
        )
        queue = BucketQueue.spanning(table.longest + DIAGONAL)
        total, self._pool = _search(grid, query, queue, self._pool)
        if total < 0:
            return None
        ends = grid.index_of(start), grid.index_of(goal)
        return _trace(self._records, grid.stride, *ends), total

    def _prepare(self, size: int) -> None:
        self._stamp -= 1
        if self._records.size != size or self._stamp < 0:
            self._records = np.full(size, np.iinfo(np.int64).max, np.int64)
            self._stamp = _FIRST_STAMP


class _Query(NamedTuple):
    """Ends in the rimmed grid, the query's stamp in a record, and the records."""

    start_row: int
    start_column: int
    goal_row: int
    goal_column: int
    base: np.int64
    records: NDArray[np.int64]


@kernel
def _search(grid: Any, query: Any, queue: Any, pool: Any) -> Any:
    """Search the grid; return (g of the goal or −1, the pool).

    An open item is row << 16 | column.
    """
    stride, records, state, shift = (
        grid.stride,
        query.records,
        queue.state,
        queue.shift,
    )
    row, column = query.start_row, query.start_column
    bucket = _octile(row - query.goal_row, column - query.goal_column) >> shift
    records[row * stride + column] = query.base
    push(pool, queue, bucket, (row << 16) | column)
    best: Any = np.int64(_NEVER)
    while state[WAITING] > 0 and bucket <= best >> shift:
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
        pool = reserve(pool, queue, 8)
        g = (record >> 4) & _G_MASK
        best = _expand(grid, query, queue, pool, row, column, g, best)
    return (best if best < _NEVER else np.int64(-1)), pool


@kernel(forceinline=True)
def _expand(
    grid: Any,
    query: Any,
    queue: Any,
    pool: Any,
    row: int,
    column: int,
    g: int,
    best: int,
) -> Any:
    """Offer g + edge to the eight neighbours; return the goal's least g so far."""
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
        reached = np.uint64(index + steps[k])
        if k < 4:
            edge = orthogonal[k]
        elif orthogonal[(k - 4) >> 1] == 0 or orthogonal[2 + (k & 1)] == 0:
            continue
        else:
            edge = diagonal[cost[reached]]
        candidate = base | ((g + edge) << 4) | k
        if edge == 0 or (candidate | 15) >= records[reached]:
            continue
        row_new, column_new = row + rows[k], column + columns[k]
        f = g + edge + _octile(row_new - query.goal_row, column_new - query.goal_column)
        if f >= best:
            continue
        records[reached] = candidate
        if row_new == query.goal_row and column_new == query.goal_column:
            best = g + edge
        else:
            push(pool, queue, f >> queue.shift, (row_new << 16) | column_new)
    return best


@kernel(forceinline=True)
def _octile(rows: Any, columns: Any) -> Any:
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
