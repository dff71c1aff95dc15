"""Dijkstra's search: the cheapest way from every cell to a goal.

Dijkstra 1959, run from the goal outwards; the open list is a circle of buckets
(Dial 1969). The wave may stop once it has passed the start. The result is the same
cost as A* finds; the field of costs also guides the lattice search.
"""

from collections.abc import Sequence
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
    Cell,
    EdgeTable,
    require_inside,
    with_rim,
)

UNREACHED = 1 << 60
"""Cost to go of a cell that no way leads from."""

Field = NDArray[np.int64]


def search(
    cost: NDArray[np.uint8],
    start: Cell,
    goal: Cell,
    *,
    table: EdgeTable | None = None,
) -> tuple[NDArray[np.int64], int] | None:
    """Cells (N, 2) row, column from start to goal, and the cost in units.

    None when there is no way, or an end is closed. The start's own cost does not
    count.
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
    """Field (H, W) of the cost in units from each cell to the cheapest goal.

    Args:
        cost: (H, W) cell costs.
        goals: cells with a cost in units that arriving there adds; closed ones
            are skipped.
        until: stop when this cell's value is final; dearer cells may then hold a
            value that is too high, or :data:`UNREACHED`.
    """
    for cell, _ in goals:
        require_inside(cell, cost.shape, "goal")
    if until is not None:
        require_inside(until, cost.shape, "start")
    rimmed = with_rim(cost)
    field = np.full(rimmed.size, UNREACHED, np.int64)
    seeds = np.array([(r + 1, c + 1, g) for (r, c), g in goals], np.int64)
    seeds = seeds.reshape(-1, 3)
    shift, buckets = layout(table.longest + int(seeds[:, 2].max(initial=0)))
    stop = -1 if until is None else (until[0] + 1) * rimmed.shape[1] + until[1] + 1
    _spread(
        rimmed.reshape(-1),
        rimmed.shape[1],
        seeds,
        stop,
        table.straight,
        table.diagonal,
        field,
        np.zeros(field.size, np.uint8),
        new_pool(),
        np.zeros(buckets, np.int32),
        new_state(),
        shift,
    )
    return field.reshape(rimmed.shape)[1:-1, 1:-1]


def descend(
    field: Field, cost: NDArray[np.uint8], start: Cell, *, table: EdgeTable
) -> tuple[NDArray[np.int64], int] | None:
    """Follow a field of :func:`cost_to_go` down from ``start`` to a goal."""
    total = int(field[start])
    if total >= UNREACHED:
        return None
    rimmed_field = np.full((cost.shape[0] + 2, cost.shape[1] + 2), UNREACHED, np.int64)
    rimmed_field[1:-1, 1:-1] = field
    stride = cost.shape[1] + 2
    path = np.empty(rimmed_field.size, np.int64)
    count = _descend(
        rimmed_field.reshape(-1),
        with_rim(cost).reshape(-1),
        stride,
        (start[0] + 1) * stride + start[1] + 1,
        table.straight,
        table.diagonal,
        path,
    )
    return np.column_stack(np.divmod(path[:count], stride)) - 1, total


@njit(cache=True)
def _spread(
    cost: Any,
    stride: Any,
    seeds: Any,
    stop: Any,
    straight: Any,
    diagonal: Any,
    field: Any,
    closed: Any,
    pool: Any,
    heads: Any,
    state: Any,
    shift: Any,
) -> Any:
    """Lower ``field`` (flat, rimmed) from the seeds outwards.

    An entry's item is row << 16 | column; entering a cell costs by that cell, so a
    step back from it costs by the cell that the wave comes from.
    """
    steps = (-stride, stride, -1, 1, -stride - 1, -stride + 1, stride - 1, stride + 1)
    rows = (-1, 1, 0, 0, -1, -1, 1, 1)
    columns = (0, 0, -1, 1, -1, 1, -1, 1)
    for i in range(seeds.shape[0]):
        index = seeds[i, 0] * stride + seeds[i, 1]
        if straight[cost[index]] != 0 and seeds[i, 2] < field[index]:
            field[index] = seeds[i, 2]
            pool = reserve(pool, state, 1)
            item = (seeds[i, 0] << 16) | seeds[i, 1]
            push(pool, heads, state, seeds[i, 2] >> shift, item)
    bucket = 0
    while state[WAITING] > 0 and (stop < 0 or bucket <= field[stop] >> shift):
        item = pop(pool, heads, state, bucket)
        if item < 0:
            bucket += 1
            continue
        row, column = item >> 16, item & 0xFFFF
        index = np.uint64(row * stride + column)
        if closed[index]:
            continue
        closed[index] = 1
        pool = reserve(pool, state, 8)
        g_straight = field[index] + straight[cost[index]]
        g_diagonal = field[index] + diagonal[cost[index]]
        for k in range(8):
            reached = np.uint64(row * stride + column + steps[k])
            g = g_straight if k < 4 else g_diagonal
            if g >= field[reached] or straight[cost[reached]] == 0:
                continue
            if k >= 4 and _corner(cost, straight, row * stride + column, stride, k):
                continue
            field[reached] = g
            closed[reached] = 0
            item = ((row + rows[k]) << 16) | (column + columns[k])
            push(pool, heads, state, g >> shift, item)


@njit(cache=True, forceinline=True)
def _corner(cost: Any, straight: Any, index: int, stride: int, k: int) -> bool:
    """Whether diagonal move ``k`` passes a closed orthogonal neighbour."""
    vertical = index - stride if k < 6 else index + stride
    sideways = index - 1 if k & 1 == 0 else index + 1
    return bool(
        straight[cost[np.uint64(vertical)]] == 0
        or straight[cost[np.uint64(sideways)]] == 0
    )


@njit(cache=True)
def _descend(
    field: Any,
    cost: Any,
    stride: int,
    index: int,
    straight: Any,
    diagonal: Any,
    path: Any,
) -> int:
    """Cells in ``path``, along which ``field`` falls by just the step's cost."""
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
            if k < 4 or not _corner(cost, straight, index, stride, k):
                found = k
                break
        if found < 0:
            return count
        index += steps[found]
