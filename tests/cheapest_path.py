"""An independent, slow search: the reference for the planner's searches."""

import heapq

import numpy as np
from numpy.typing import NDArray

from navette.navigation.planning.traversal import (
    DIAGONAL,
    LETHAL,
    MAX_PASSABLE_COST,
    STRAIGHT,
    EdgeTable,
)


def cheapest(
    cost: NDArray[np.uint8],
    start: tuple[int, int],
    goal: tuple[int, int],
    table: EdgeTable,
) -> int | None:
    """Cost in units of the cheapest path, by plain Dijkstra with a heap."""
    free = {tuple(cell) for cell in np.argwhere(cost < LETHAL).tolist()}
    best, waiting = {start: 0}, [(0, start)]
    if not {start, goal} <= free:
        return None
    while waiting:
        g, (row, column) = heapq.heappop(waiting)
        if (row, column) == goal:
            return g
        for dr, dc in ((a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if a or b):
            to = (row + dr, column + dc)
            if not {to, (row + dr, column), (row, column + dc)} <= free:
                continue
            unit = DIAGONAL if dr and dc else STRAIGHT
            there = g + round(
                unit * (1 + table.weight * int(cost[to]) / MAX_PASSABLE_COST)
            )
            if there < best.get(to, 1 << 60):
                best[to] = there
                heapq.heappush(waiting, (there, to))
    return None
