"""Dijkstra's search: the cheapest path from every cell to a goal.

Dijkstra 1959, run from the goal outwards; the open list is a circle of buckets
(Dial 1969). With a start, the wave spreads towards it first, as in A*, and stops behind
it. The path has the same cost as that of A*; the costs also guide the lattice search.
"""

from collections.abc import Sequence
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
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.traversal import (
    DIAGONAL,
    STRAIGHT,
    Cell,
    EdgeTable,
    SearchGrid,
    require_inside,
)

UNREACHED = 1 << 60
"""Cost to go of a cell without a path to a goal."""
_NEIGHBOURS = 8

Field = NDArray[np.int64]


class Guide(NamedTuple):
    """Cost to go of the cells on the ways from a start to the goals.

    Attributes:
        grid: the cells.
        left: ((H + 2) · (W + 2),) :data:`UNREACHED` less the cost to go, so that what
            is never written occupies no memory.
        closed: of the same shape, whether the cost is final.
        limit: stands for the costs that are not; UNREACHED if all are.
        met: (1,) whether :func:`to_go` has returned the limit.
    """

    grid: SearchGrid
    left: NDArray[np.int64]
    closed: NDArray[np.uint8]
    limit: int
    met: NDArray[np.bool_]


@PLANNERS.register("dijkstra")
def search(
    cost: NDArray[np.uint8],
    start: Cell,
    goal: Cell,
    *,
    table: EdgeTable | None = None,
) -> tuple[NDArray[np.int64], int] | None:
    """Return cells (N, 2) row, column from start to goal, and the cost in units.

    None if no path exists, or an end is closed. The start's own cost does not count.
    """
    table = table or EdgeTable()
    guide = _spread_from([(goal, 0)], cost, table, until=start)
    here = guide.grid.index_of(start)
    if guide.left[here] == 0:
        return None
    path = np.empty(guide.left.size, np.int64)
    count = _descend(guide, here, path)
    cells = np.column_stack(np.divmod(path[:count], guide.grid.stride)) - 1
    return cells, UNREACHED - int(guide.left[here])


def cost_to_go(
    cost: NDArray[np.uint8], goals: Sequence[tuple[Cell, int]], *, table: EdgeTable
) -> Field:
    """Return the cost (H, W) in units from each cell to the cheapest goal.

    Args:
        cost: (H, W) cell costs.
        goals: cells with a cost in units that is added on arrival; closed ones are
            skipped.
        table: cost of entering a cell.
    """
    found = _spread_from(goals, cost, table)
    return (UNREACHED - found.left).reshape(-1, found.grid.stride)[1:-1, 1:-1]


def guide_to(
    cost: NDArray[np.uint8],
    goals: Sequence[tuple[Cell, int]],
    *,
    table: EdgeTable,
    start: Cell,
    beyond: int,
) -> Guide:
    """Return the cost from cells to the cheapest goal, for :func:`to_go`.

    Args:
        cost, goals, table: as for :func:`cost_to_go`.
        start: only cells on the cheapest ways from there to the goals get their cost …
        beyond: … and on ways that cost up to this much more, in units.
    """
    return _spread_from(goals, cost, table, until=start, beyond=beyond, directed=True)


def _spread_from(
    goals: Sequence[tuple[Cell, int]],
    cost: NDArray[np.uint8],
    table: EdgeTable,
    *,
    until: Cell | None = None,
    beyond: int = 0,
    directed: bool = False,
) -> Guide:
    """Spread from the goals to all cells, or to one, perhaps towards it first."""
    for cell, _ in goals:
        require_inside(cell, cost.shape, "goal")
    if until is not None:
        require_inside(until, cost.shape, "start")
    grid = SearchGrid.of(cost, table)
    wave = _Wave(
        sparse_zeros(grid.cost.shape, np.int64),
        sparse_zeros(grid.cost.shape, np.uint8),
        -1 if until is None else grid.index_of(until),
        beyond,
        directed,
    )
    cells = np.array([cell for cell, _ in goals], np.int64).reshape(-1, 2) + 1
    extra = np.array([units for _, units in goals], np.int64)
    apart = extra.max(initial=0)
    if directed and len(cells):  # the bounds of two cells differ as far as they lie
        apart += DIAGONAL * np.ptp(cells, axis=0).max()
    queue = BucketQueue.spanning(int(apart) + table.longest + DIAGONAL)
    limit = _spread(grid, cells, extra, wave, queue, new_pool())
    return Guide(grid, wave.left, wave.closed, limit, np.zeros(1, np.bool_))


@kernel(allocates=False)
def to_go(guide: Any, row: int, column: int) -> int:
    """Return the cost to go of a cell, or the limit; UNREACHED without a path."""
    at = np.uint64((row + 1) * guide.grid.stride + column + 1)
    if guide.closed[at] != 0:
        cost: int = UNREACHED - guide.left[at]
        return cost
    if guide.limit == UNREACHED or guide.grid.straight[guide.grid.cost[at]] == 0:
        return UNREACHED
    guide.met[0] = True
    limit: int = guide.limit
    return limit


class _Wave(NamedTuple):
    """State of the search, flat and rimmed.

    Attributes:
        left: UNREACHED less the least cost so far.
        closed: whether that is final.
        stop: index of the start, behind which the wave stops, −1 nowhere.
        beyond: cost by which ways may be longer than the least.
        directed: whether the wave spreads towards the start first.
    """

    left: NDArray[np.int64]
    closed: NDArray[np.uint8]
    stop: int
    beyond: int
    directed: bool


@kernel
def _spread(grid: Any, cells: Any, extra: Any, wave: Any, queue: Any, pool: Any) -> int:
    """Lower the costs from cells (N, 2) with an extra cost (N,) outwards.

    Return the cost of a way below which all are final; UNREACHED if all are.

    An entry's item is row << 16 | column. A step is charged for the cell it enters, so
    a step of the wave is charged for the cell that it comes from.
    """
    bucket: Any = np.int64(UNREACHED)
    for i in range(cells.shape[0]):
        row, column = cells[i, 0], cells[i, 1]
        index, there = row * grid.stride + column, UNREACHED - extra[i]
        if grid.straight[grid.cost[index]] != 0 and there > wave.left[index]:
            wave.left[index] = there
            pool = reserve(pool, queue, 1)
            slot = (extra[i] + _from_start(grid, wave, row, column)) >> queue.shift
            push(pool, queue, slot, (row << 16) | column)
            bucket = min(bucket, slot)
    done = False
    while not done:
        pool = reserve(pool, queue, _NEIGHBOURS)
        bucket, done = _spread_while_room(grid, wave, queue, pool, bucket)
    return int(bucket << queue.shift) if queue.state[WAITING] > 0 else UNREACHED


@kernel(allocates=False)
def _spread_while_room(
    grid: Any, wave: Any, queue: Any, pool: Any, bucket: Any
) -> tuple[int, bool]:
    """Spread until the wave is done or the pool full; return the bucket and which."""
    cost, stride, straight, diagonal = grid
    left, closed, stop, beyond, _ = wave
    state, shift = queue.state, queue.shift
    steps = (-stride, stride, -1, 1, -stride - 1, -stride + 1, stride - 1, stride + 1)
    rows = (-1, 1, 0, 0, -1, -1, 1, 1)
    columns = (0, 0, -1, 1, -1, 1, -1, 1)
    while state[WAITING] > 0 and (
        stop < 0 or bucket <= (UNREACHED - left[stop] + beyond) >> shift
    ):
        if not has_room(pool, queue, _NEIGHBOURS):
            return bucket, False
        item = pop(pool, queue, bucket)
        if item < 0:
            bucket += 1
            continue
        row, column = item >> 16, item & 0xFFFF
        index = np.uint64(row * stride + column)
        if closed[index]:
            continue
        closed[index] = 1
        to_straight = left[index] - straight[cost[index]]
        to_diagonal = left[index] - diagonal[cost[index]]
        for k in range(8):
            reached = np.uint64(row * stride + column + steps[k])
            there = to_straight if k < 4 else to_diagonal
            if there <= left[reached] or straight[cost[reached]] == 0:
                continue
            if k >= 4 and _corner(grid, row * stride + column, k):
                continue
            left[reached] = there
            closed[reached] = 0
            to_row, to_column = row + rows[k], column + columns[k]
            way = UNREACHED - there + _from_start(grid, wave, to_row, to_column)
            push(pool, queue, way >> shift, (to_row << 16) | to_column)
    return bucket, True


@kernel(allocates=False, forceinline=True)
def _from_start(grid: Any, wave: Any, row: int, column: int) -> int:
    """Return a lower bound on the cost from the start to a cell, as in A*."""
    if not wave.directed:
        return 0
    rows = abs(row - wave.stop // grid.stride)
    columns = abs(column - wave.stop % grid.stride)
    return int(
        STRAIGHT * max(rows, columns) + (DIAGONAL - STRAIGHT) * min(rows, columns)
    )


@kernel(allocates=False, forceinline=True)
def _corner(grid: Any, index: int, k: int) -> bool:
    """Return whether diagonal move ``k`` passes a closed orthogonal neighbour."""
    cost, stride, straight, _ = grid
    vertical = index - stride if k < 6 else index + stride
    sideways = index - 1 if k & 1 == 0 else index + 1
    return bool(
        straight[cost[np.uint64(vertical)]] == 0
        or straight[cost[np.uint64(sideways)]] == 0
    )


@kernel(allocates=False)
def _descend(guide: Any, index: int, path: Any) -> int:
    """Fill ``path`` with cells along which the cost falls by exactly the step's.

    Returns the number of cells.
    """
    grid, left = guide.grid, guide.left
    cost, stride, straight, diagonal = grid
    steps = (-stride, stride, -1, 1, -stride - 1, -stride + 1, stride - 1, stride + 1)
    count = 0
    while True:
        path[count] = index
        count += 1
        found = -1
        for k in range(8):
            reached = index + steps[k]
            edge = straight[cost[reached]] if k < 4 else diagonal[cost[reached]]
            if edge == 0 or left[reached] - edge != left[index]:
                continue
            if k < 4 or not _corner(grid, index, k):
                found = k
                break
        if found < 0:
            return count
        index += steps[found]
