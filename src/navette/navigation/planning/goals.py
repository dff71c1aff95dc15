"""Choose a cell to plan to if the goal's own cell is not reachable."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import CellWindow, GridSpec
from navette.navigation.planning.connection import first_connected
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid
from navette.navigation.planning.traversal import LETHAL, Cell


def nearest_reachable(
    grid: PlanningGrid,
    start: Cell,
    goal_xy: tuple[float, float],
    tolerance_m: float,
    body: BodyShape,
) -> tuple[Cell | None, Outcome]:
    """Return the reachable cell nearest to the goal, or None and the reason.

    The time does not depend on the size of the map.
    """
    cells, away = cells_near(grid.spec, goal_xy, tolerance_m)
    nearest_first = cells[np.argsort(away, kind="stable")]
    best = first_connected(grid.cost, start, nearest_first, grid.table)
    if best is not None:
        row, column = nearest_first[best].tolist()
        return (row, column), Outcome.GOAL_SNAPPED
    if _is_enclosed(grid, start, body):
        return None, Outcome.START_BLOCKED
    if (grid.cost[cells[:, 0], cells[:, 1]] == LETHAL).all():
        return None, Outcome.GOAL_BLOCKED
    return None, Outcome.NO_PATH


def cells_near(
    spec: GridSpec, xy: tuple[float, float], radius_m: float
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return cells (N, 2) with centres within the radius, and distances (N,), metres.

    The point's own cell is always included.
    """
    row, column = spec.cell_of(*xy)
    reach = math.ceil(radius_m / spec.resolution)
    rows = np.arange(max(0, row - reach), min(spec.height, row + reach + 1))
    columns = np.arange(max(0, column - reach), min(spec.width, column + reach + 1))
    cells = np.stack(np.meshgrid(rows, columns, indexing="ij"), -1).reshape(-1, 2)
    gaps = spec.centers_of(cells) - xy
    away = np.hypot(gaps[:, 0], gaps[:, 1])
    near = (away <= radius_m) | ((cells == (row, column)).all(axis=1))
    return cells[near], away[near]


def _is_enclosed(grid: PlanningGrid, start: Cell, body: BodyShape) -> bool:
    """Return whether no path leads out of the body's own radius."""
    reach = body.circumscribed_m / grid.spec.resolution
    # A path that leaves the radius does so within the window.
    window = CellWindow(start[0], start[0] + 1, start[1], start[1] + 1).grown(
        math.ceil(reach) + 2, grid.cost.shape
    )
    cost = grid.cost[window.slices]
    middle = start[0] - window.first_row, start[1] - window.first_column
    cells = np.argwhere(cost != LETHAL)
    outside = cells[np.hypot(*(cells - middle).T) > reach]
    return first_connected(cost, middle, outside, grid.table) is None
