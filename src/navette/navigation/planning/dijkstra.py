"""Dijkstra's search: the cheapest path from every cell to a goal.

Dijkstra 1959, run from the goal outwards; the open list is a circle of buckets
(Dial 1969). The wave may stop once it has passed the start. The path has the same cost
as that of A*; the field of costs also guides the lattice search.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
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
    field = cost_to_go(cost, [(goal, 0)], table=table, until=start)
    return descend(field, cost, start, table=table)


def cost_to_go(
    cost: NDArray[np.uint8],
    goals: Sequence[tuple[Cell, int]],
    *,
    table: EdgeTable,
    until: Cell | None = None,
) -> Field:
    """Return the cost (H, W) in units from each cell to the cheapest goal.

    Args:
        cost: (H, W) cell costs.
        goals: cells with a cost in units that is added on arrival; closed ones are
            skipped.
        table: cost of entering a cell.
        until: stop when this cell's value is final; cells of higher cost may then
            hold a value that is too high, or :data:`UNREACHED`.
    """
    for cell, _ in goals:
        require_inside(cell, cost.shape, "goal")
    if until is not None:
        require_inside(until, cost.shape, "start")
    grid = SearchGrid.of(cost, table)
    wave = _Wave(
        np.full(grid.cost.size, UNREACHED, np.int64),
        np.zeros(grid.cost.size, np.uint8),
        -1 if until is None else grid.index_of(until),
    )
    seeds = np.array([(r + 1, c + 1, g) for (r, c), g in goals], np.int64)
    seeds = seeds.reshape(-1, 3)
    queue = BucketQueue.spanning(table.longest + int(seeds[:, 2].max(initial=0)))
    _spread(grid, seeds, wave, queue, new_pool())
    return wave.field.reshape(-1, grid.stride)[1:-1, 1:-1]


def descend(
    field: Field, cost: NDArray[np.uint8], start: Cell, *, table: EdgeTable
) -> tuple[NDArray[np.int64], int] | None:
    """Follow a field of :func:`cost_to_go` down from ``start`` to a goal."""
    total = int(field[start])
    if total >= UNREACHED:
        return None
    rimmed_field = np.full((cost.shape[0] + 2, cost.shape[1] + 2), UNREACHED, np.int64)
    rimmed_field[1:-1, 1:-1] = field
    grid = SearchGrid.of(cost, table)
    path = np.empty(rimmed_field.size, np.int64)
    count = _descend(grid, rimmed_field.reshape(-1), grid.index_of(start), path)
    return np.column_stack(np.divmod(path[:count], grid.stride)) - 1, total


class _Wave(NamedTuple):
    """State of the search, flat and rimmed.

    Attributes:
        field: least cost so far.
        closed: whether that is final.
        stop: index at whose final value the search ends, −1 never.
    """

    field: Field
    closed: NDArray[np.uint8]
    stop: int


@kernel
def _spread(grid: Any, seeds: Any, wave: Any, queue: Any, pool: Any) -> None:
    """Lower the field from the seeds (N, 3) row, column, cost outwards.

    An entry's item is row << 16 | column. A step is charged for the cell it enters, so
    a step of the wave is charged for the cell that it comes from.
    """
    field = wave.field
    for i in range(seeds.shape[0]):
        index = seeds[i, 0] * grid.stride + seeds[i, 1]
        if grid.straight[grid.cost[index]] != 0 and seeds[i, 2] < field[index]:
            field[index] = seeds[i, 2]
            pool = reserve(pool, queue, 1)
            item = (seeds[i, 0] << 16) | seeds[i, 1]
            push(pool, queue, seeds[i, 2] >> queue.shift, item)
    bucket: Any = np.int64(0)
    while bucket >= 0:
        pool = reserve(pool, queue, _NEIGHBOURS)
        bucket = _spread_while_room(grid, wave, queue, pool, bucket)


@kernel(allocates=False)
def _spread_while_room(grid: Any, wave: Any, queue: Any, pool: Any, bucket: Any) -> int:
    """Spread until the wave is done (−1), or the pool is full; return the bucket."""
    cost, stride, straight, diagonal = grid
    field, closed, stop = wave
    state, shift = queue.state, queue.shift
    steps = (-stride, stride, -1, 1, -stride - 1, -stride + 1, stride - 1, stride + 1)
    rows = (-1, 1, 0, 0, -1, -1, 1, 1)
    columns = (0, 0, -1, 1, -1, 1, -1, 1)
    while state[WAITING] > 0 and (stop < 0 or bucket <= field[stop] >> shift):
        if not has_room(pool, queue, _NEIGHBOURS):
            return int(bucket)
        item = pop(pool, queue, bucket)
        if item < 0:
            bucket += 1
            continue
        row, column = item >> 16, item & 0xFFFF
        index = np.uint64(row * stride + column)
        if closed[index]:
            continue
        closed[index] = 1
        g_straight = field[index] + straight[cost[index]]
        g_diagonal = field[index] + diagonal[cost[index]]
        for k in range(8):
            reached = np.uint64(row * stride + column + steps[k])
            g = g_straight if k < 4 else g_diagonal
            if g >= field[reached] or straight[cost[reached]] == 0:
                continue
            if k >= 4 and _corner(grid, row * stride + column, k):
                continue
            field[reached] = g
            closed[reached] = 0
            item = ((row + rows[k]) << 16) | (column + columns[k])
            push(pool, queue, g >> shift, item)
    return -1


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
def _descend(grid: Any, field: Any, index: int, path: Any) -> int:
    """Fill ``path`` with cells along which ``field`` falls by exactly the step's cost.

    Returns the number of cells.
    """
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
            if edge == 0 or field[reached] + edge != field[index]:
                continue
            if k < 4 or not _corner(grid, index, k):
                found = k
                break
        if found < 0:
            return count
        index += steps[found]
