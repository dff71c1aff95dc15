"""Breadth-first search: the path with the fewest moves (Moore 1959).

The simplest search, for teaching and comparison. It distinguishes free and closed cells
only and ignores costs. Straight moves are tried first, so that among paths of equally
many moves the straighter one is found. Diagonal moves need both orthogonal neighbours
free.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.traversal import (
    Cell,
    EdgeTable,
    SearchGrid,
    require_inside,
    steps_cost,
)


@PLANNERS.register("breadth_first")
def search(
    cost: NDArray[np.uint8],
    start: Cell,
    goal: Cell,
    *,
    table: EdgeTable | None = None,
) -> tuple[NDArray[np.int64], int] | None:
    """Return cells (N, 2) row, column from start to goal, and their cost in units.

    None if no path exists, or an end is closed. The search ignores the costs.
    """
    table = table or EdgeTable()
    require_inside(start, cost.shape, "start")
    require_inside(goal, cost.shape, "goal")
    grid = SearchGrid.of(cost, table)
    stride = grid.stride
    closed = table.straight[grid.cost] == 0
    here, there = grid.index_of(start), grid.index_of(goal)
    if closed[here] or closed[there]:
        return None
    # The flood starts at the goal, so that following parents leads to the goal.
    parent = np.full(closed.size, -1, np.int32)
    _flood(closed, stride, here, there, parent, np.empty(closed.size, np.int32))
    if parent[here] < 0:
        return None
    chain = [here]
    while chain[-1] != there:
        chain.append(int(parent[chain[-1]]))
    cells = np.column_stack(np.divmod(np.array(chain), stride)) - 1
    return cells, steps_cost(cells, cost, table)


@kernel
def _flood(
    closed: Any, stride: int, start: int, goal: int, parent: Any, queue: Any
) -> None:
    """Set the parents (towards the goal; −1 none) of cells until the start has one."""
    steps = (-stride, stride, -1, 1, -stride - 1, -stride + 1, stride - 1, stride + 1)
    queue[0], head, tail = goal, 0, 1
    parent[goal] = goal
    while head < tail and parent[start] < 0:
        index = np.int64(queue[head])
        head += 1
        for k in range(8):
            reached = index + steps[k]
            if parent[reached] >= 0 or closed[reached]:
                continue
            vertical, sideways = index + steps[(k - 4) >> 1], index + steps[2 + (k & 1)]
            if k >= 4 and (closed[vertical] or closed[sideways]):
                continue
            parent[reached] = index
            queue[tail] = reached
            tail += 1
