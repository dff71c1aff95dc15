"""A*: the cheapest 8-connected way between two cells, exact.

Hart, Nilsson and Raphael 1968, with an open list as in Dial 1969: a circle of
buckets over fixed-point f. A bucket is a last-in-first-out list of cells, so the
search dives towards the goal; cells whose g falls are opened again, and the search
ends when the goal's own bucket is empty, which keeps the result exact.
Diagonal moves need both orthogonal neighbours free.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.navigation.planning.bucket_queue import (
    WAITING,
    layout,
    new_pool,
    new_state,
    pop,
    push,
    reserve,
)
from navette.navigation.planning.traversal import (
    DIAGONAL,
    STRAIGHT,
    Cell,
    EdgeTable,
    require_inside,
    with_rim,
)

# A record per cell: stamp << 48 | g << 4 | closed << 3 | direction. The stamp falls
# with every query, so what an earlier query left compares as "dearer than anything"
# and nothing needs clearing.
_FIRST_STAMP = 32_766
_G_MASK = (1 << 44) - 1
_OBLIQUE = DIAGONAL - STRAIGHT
_CLOSED = 8
_NEVER = 1 << 60


class AStar:
    """Keeps the working arrays between queries; the result depends on them never."""

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
        """Cells (N, 2) row, column from start to goal, and the cost in units.

        Args:
            cost: (H, W) cell costs; ``table`` says what entering each costs.

        Returns:
            None when there is no way, or an end is closed. The start's own cost
            does not count.
        """
        require_inside(start, cost.shape, "start")
        require_inside(goal, cost.shape, "goal")
        return self.search_rimmed(
            with_rim(cost), start, goal, table=table or EdgeTable()
        )

    def search_rimmed(
        self,
        rimmed: NDArray[np.uint8],
        start: Cell,
        goal: Cell,
        *,
        table: EdgeTable,
    ) -> tuple[NDArray[np.int64], int] | None:
        """As :meth:`search` on a grid that :func:`with_rim` made."""
        stride = rimmed.shape[1]
        ends = rimmed[(start[0] + 1, goal[0] + 1), (start[1] + 1, goal[1] + 1)]
        if not table.straight[ends].all():
            return None
        if start == goal:
            return np.array([start], np.int64), 0
        self._prepare(rimmed.size)
        shift, buckets = layout(table.longest + DIAGONAL)
        total, self._pool = _search(
            rimmed.reshape(-1),
            stride,
            (start[0] + 1, start[1] + 1),
            (goal[0] + 1, goal[1] + 1),
            table.straight,
            table.diagonal,
            self._records,
            self._stamp,
            self._pool,
            np.zeros(buckets, np.int32),
            new_state(),
            shift,
        )
        if total < 0:
            return None
        cells = _trace(
            self._records,
            stride,
            (start[0] + 1) * stride + start[1] + 1,
            (goal[0] + 1) * stride + goal[1] + 1,
        )
        return cells, total

    def _prepare(self, size: int) -> None:
        self._stamp -= 1
        if self._records.size != size or self._stamp < 0:
            self._records = np.full(size, np.iinfo(np.int64).max, np.int64)
            self._stamp = _FIRST_STAMP


@njit(cache=True)
def _search(
    cost: Any,
    stride: Any,
    start: Any,
    goal: Any,
    straight: Any,
    diagonal: Any,
    records: Any,
    stamp: Any,
    pool: Any,
    heads: Any,
    state: Any,
    shift: Any,
) -> Any:
    """Search the flat rimmed grid; returns (g of the goal or -1, the pool).

    An open item is row << 16 | column.
    """
    base = np.int64(stamp) << 48
    bucket = _octile(start[0] - goal[0], start[1] - goal[1]) >> shift
    records[start[0] * stride + start[1]] = base
    push(pool, heads, state, bucket, (start[0] << 16) | start[1])
    best = np.int64(_NEVER)
    while state[WAITING] > 0 and bucket <= best >> shift:
        item = pop(pool, heads, state, bucket)
        if item < 0:
            bucket += 1
            continue
        row, column = item >> 16, item & 0xFFFF
        index = np.uint64(row * stride + column)
        record = records[index]
        if record & _CLOSED:
            continue
        records[index] = record | _CLOSED
        pool = reserve(pool, state, 8)
        best = _expand(
            cost, stride, row, column, goal, straight, diagonal, records,
            base, (record >> 4) & _G_MASK, best, pool, heads, state, shift,
        )  # fmt: skip
    return (best if best < _NEVER else np.int64(-1)), pool


@njit(cache=True, forceinline=True)
def _expand(
    cost: Any,
    stride: Any,
    row: Any,
    column: Any,
    goal: Any,
    straight: Any,
    diagonal: Any,
    records: Any,
    base: Any,
    g: Any,
    best: Any,
    pool: Any,
    heads: Any,
    state: Any,
    shift: Any,
) -> Any:
    """Offer g + edge to the eight neighbours; returns the goal's best g so far."""
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
        f = g + edge + _octile(row_new - goal[0], column_new - goal[1])
        if f >= best:
            continue
        records[reached] = candidate
        if row_new == goal[0] and column_new == goal[1]:
            best = g + edge
        else:
            push(pool, heads, state, f >> shift, (row_new << 16) | column_new)
    return best


@njit(cache=True, forceinline=True)
def _octile(
    rows: Any,
    columns: Any,
) -> Any:
    """Cheapest way over free cells: the heuristic."""
    rows = rows if rows >= 0 else -rows
    columns = columns if columns >= 0 else -columns
    if rows > columns:
        return STRAIGHT * rows + _OBLIQUE * columns
    return STRAIGHT * columns + _OBLIQUE * rows


@njit(cache=True)
def _trace(
    records: Any,
    stride: Any,
    start_index: Any,
    goal_index: Any,
) -> Any:
    """Cells (N, 2) of the unrimmed grid, start first, by the stored directions."""
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
