"""Choose a cell to plan to if the goal's own cell is not reachable."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import GridSpec
from navette.navigation.planning.breadth_first import reachable
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

    Reachable cells are found by a flood from the start.
    """
    reached = reachable(grid.cost, start, grid.table)
    cells, away = cells_within(grid, goal_xy, tolerance_m)
    rows, columns = cells[:, 0], cells[:, 1]
    there = reached[rows, columns]
    if there.any():
        best = int(np.argmin(np.where(there, away, np.inf)))
        return (int(rows[best]), int(columns[best])), Outcome.GOAL_SNAPPED
    if _is_enclosed(reached, grid, start, body):
        return None, Outcome.START_BLOCKED
    if (grid.cost[rows, columns] == LETHAL).all():
        return None, Outcome.GOAL_BLOCKED
    return None, Outcome.NO_PATH


def cells_within(
    grid: PlanningGrid, xy: tuple[float, float], radius_m: float
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return :func:`cells_near` of a planning grid."""
    return cells_near(grid.spec, xy, radius_m)


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


def _is_enclosed(
    reached: NDArray[np.bool_], grid: PlanningGrid, start: Cell, body: BodyShape
) -> bool:
    """Return whether the flood stayed within the body's own radius."""
    cells = np.argwhere(reached)
    away = np.hypot(*(cells - start).T) * grid.spec.resolution
    return bool((away <= body.circumscribed_m).all())
