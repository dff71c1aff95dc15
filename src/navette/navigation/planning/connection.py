"""Whether cells are connected, in a time that does not depend on the size of the map.

Two floods spread in turns, from both cells, until they meet or one of them ends: the
time depends on how far apart the cells are, or on the smaller of their areas.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import sparse_zeros
from navette.navigation.planning.traversal import (
    Cell,
    EdgeTable,
    SearchGrid,
    require_inside,
)

# Owners of a cell.
_NONE, _START, _END = 0, 1, 2


def first_connected(
    cost: NDArray[np.uint8], start: Cell, cells: NDArray[np.int64], table: EdgeTable
) -> int | None:
    """Return the index of the first cell that has a path to the start, or None.

    Args:
        cost: (H, W) cell costs.
        start: no path begins at a closed start.
        cells: (N, 2) row and column, in the order in which they are tried.
        table: which cells are closed.
    """
    require_inside(start, cost.shape, "start")
    grid = SearchGrid.of(cost, table)
    if not grid.is_open(start):
        return None
    ends = (cells[:, 0] + 1) * grid.stride + cells[:, 1] + 1
    owner = sparse_zeros(grid.cost.shape, np.uint8)
    queues = [np.empty(grid.cost.size, np.int32) for _ in range(2)]
    found = _first_connected(grid, grid.index_of(start), ends, owner, *queues)
    return None if found < 0 else int(found)


def is_cut_off(grid: SearchGrid, cell: int, other: int, most: int) -> bool:
    """Return whether a flood from a cell ends without the other one.

    Args:
        grid: the cells.
        cell, other: flat indices.
        most: False if the flood has more cells.
    """
    owner = sparse_zeros(grid.cost.shape, np.uint8)
    queue = np.empty(most + 8, np.int32)
    return bool(_is_cut_off(grid, cell, other, owner, queue))


@kernel
def _is_cut_off(grid: Any, cell: int, other: int, owner: Any, queue: Any) -> bool:
    queue[0], owner[cell] = cell, _END
    head: Any = np.int64(0)
    tail: Any = np.int64(1)
    while head < tail and tail + 8 <= queue.size and owner[other] == _NONE:
        tail, _ = _flood_from(grid, queue, head, tail, owner, _END)
        head += 1
    return bool(head == tail and owner[other] == _NONE)


@kernel
def _first_connected(
    grid: Any, start: int, ends: Any, owner: Any, reached: Any, around: Any
) -> int:
    """Return the index of the first end that the start's flood meets, or −1.

    ``reached`` and ``around`` are the queues of the start's flood and the end's.
    """
    reached[0], owner[start] = start, _START
    done: Any = np.int64(0)
    filled: Any = np.int64(1)
    for i in range(ends.size):
        end = ends[i]
        if owner[end] == _START:
            return i
        if owner[end] == _END or grid.straight[grid.cost[end]] == 0:
            continue  # an end before this one was in the same area
        around[0], owner[end] = end, _END
        head: Any = np.int64(0)
        tail: Any = np.int64(1)
        while head < tail and done < filled:
            tail, meets = _flood_from(grid, around, head, tail, owner, _END)
            if not meets:
                filled, meets = _flood_from(grid, reached, done, filled, owner, _START)
            if meets:
                return i
            head += 1
            done += 1
    return -1


@kernel(allocates=False)
def _flood_from(
    grid: Any, queue: Any, head: int, tail: int, owner: Any, mine: int
) -> tuple[int, bool]:
    """Add the open neighbours of a queue's head; return its end, whether floods met."""
    cost, stride, straight, _ = grid
    index = np.int64(queue[head])
    steps = (-stride, stride, -1, 1, -stride - 1, -stride + 1, stride - 1, stride + 1)
    for k in range(8):
        near = index + steps[k]
        if owner[near] == mine or straight[cost[near]] == 0:
            continue
        if k >= 4:
            vertical = index + steps[(k - 4) >> 1]
            sideways = index + steps[2 + (k & 1)]
            if straight[cost[vertical]] == 0 or straight[cost[sideways]] == 0:
                continue
        if owner[near] != _NONE:
            return tail, True
        owner[near] = mine
        queue[tail] = near
        tail += 1
    return tail, False
