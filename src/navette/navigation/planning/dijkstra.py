"""Dijkstra's search: the cheapest path from every cell to a goal.

Dijkstra 1959, run from the goal outwards; the open list is a circle of buckets
(Dial 1969). The wave may stop once it has passed the start. The path has the same cost
as that of A*; the costs also guide the lattice search.
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
    """Cost to go of the cells that are no farther than the start and a bit more.

    Attributes:
        grid: the cells.
        left: ((H + 2) · (W + 2),) :data:`UNREACHED` less the cost to go, 0 = not
            reached: what is never written occupies no memory.
        limit: lower bound on all costs that are not exact; UNREACHED if all are.
    """

    grid: SearchGrid
    left: NDArray[np.int64]
    limit: int


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
    guide = guide_to(cost, [(goal, 0)], table=table or EdgeTable(), until=start)
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
    found = guide_to(cost, goals, table=table)
    return (UNREACHED - found.left).reshape(-1, found.grid.stride)[1:-1, 1:-1]


def guide_to(
    cost: NDArray[np.uint8],
    goals: Sequence[tuple[Cell, int]],
    *,
    table: EdgeTable,
    until: Cell | None = None,
    beyond: int = 0,
) -> Guide:
    """Return the cost from cells to the cheapest goal, for :func:`to_go`.

    Args:
        cost, goals, table: as for :func:`cost_to_go`.
        until: no cell farther from the goals than this one gets an exact value …
        beyond: … unless the difference is no more than this, in units.
    """
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
    )
    seeds = np.array([(r + 1, c + 1, g) for (r, c), g in goals], np.int64)
    seeds = seeds.reshape(-1, 3)
    queue = BucketQueue.spanning(table.longest + int(seeds[:, 2].max(initial=0)))
    return Guide(grid, wave.left, _spread(grid, seeds, wave, queue, new_pool()))


@kernel(allocates=False)
def to_go(guide: Any, row: int, column: int) -> int:
    """Return the cost to go of a cell, at most the limit; UNREACHED without a path."""
    at = np.uint64((row + 1) * guide.grid.stride + column + 1)
    left = guide.left[at]
    if left == 0 and guide.grid.straight[guide.grid.cost[at]] == 0:
        return UNREACHED
    cost: int = min(UNREACHED - left, guide.limit)
    return cost


class _Wave(NamedTuple):
    """State of the search, flat and rimmed.

    Attributes:
        left: UNREACHED less the least cost so far.
        closed: whether that is final.
        stop: index of the cell at whose final value the search ends, −1 never.
        beyond: cost by which it goes farther.
    """

    left: NDArray[np.int64]
    closed: NDArray[np.uint8]
    stop: int
    beyond: int


@kernel
def _spread(grid: Any, seeds: Any, wave: Any, queue: Any, pool: Any) -> int:
    """Lower the costs from the seeds (N, 3) row, column, cost outwards.

    Return the cost below which all are final; UNREACHED if all are.

    An entry's item is row << 16 | column. A step is charged for the cell it enters, so
    a step of the wave is charged for the cell that it comes from.
    """
    left = wave.left
    for i in range(seeds.shape[0]):
        index = seeds[i, 0] * grid.stride + seeds[i, 1]
        there = UNREACHED - seeds[i, 2]
        if grid.straight[grid.cost[index]] != 0 and there > left[index]:
            left[index] = there
            pool = reserve(pool, queue, 1)
            item = (seeds[i, 0] << 16) | seeds[i, 1]
            push(pool, queue, seeds[i, 2] >> queue.shift, item)
    bucket: Any = np.int64(0)
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
    left, closed, stop, beyond = wave
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
            item = ((row + rows[k]) << 16) | (column + columns[k])
            push(pool, queue, (UNREACHED - there) >> shift, item)
    return bucket, True


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
