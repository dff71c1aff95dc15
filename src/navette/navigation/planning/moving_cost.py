"""Cost of where moving obstacles will be in the near term."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navette.navigation.planning.planning_grid import PlanningGrid
from navette.navigation.planning.traversal import LETHAL, MAX_PASSABLE_COST

_STEP_S = 0.25


def with_moving(
    grid: PlanningGrid, discs: NDArray[np.float64], span_s: float, body_m: float
) -> PlanningGrid:
    """Return a grid in which the cells that the discs will cover cost most.

    They stay passable: an obstacle that moves on closes neither door nor goal.

    Args:
        grid: the map without the moving obstacles.
        discs: (M, 5) x, y, vx, vy, radius; m, m/s, map.
        span_s: how far ahead.
        body_m: radius of the robot.
    """
    if not len(discs) or span_s <= 0.0:
        return grid
    cost = grid.cost.copy()
    resolution = grid.spec.resolution
    for seconds in np.arange(0.0, span_s + 1e-9, _STEP_S):
        centres = grid.to_cells(discs[:, :2] + seconds * discs[:, 2:4])
        for (u, v), radius in zip(centres, discs[:, 4], strict=True):
            reach = (radius + body_m) / resolution
            rows = slice(max(0, int(v - reach)), max(0, int(v + reach) + 1))
            columns = slice(max(0, int(u - reach)), max(0, int(u + reach) + 1))
            window = cost[rows, columns]
            dv = np.arange(rows.start, rows.start + window.shape[0]) + 0.5 - v
            du = np.arange(columns.start, columns.start + window.shape[1]) + 0.5 - u
            covered = dv[:, None] ** 2 + du[None, :] ** 2 <= reach * reach
            window[covered & (window != LETHAL)] = MAX_PASSABLE_COST
    return replace(grid, cost=cost)
