"""Planners of the user: what they get, and the checks of what they return."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import (
    Poses,
    headed,
    joined,
    resample,
    turn_in_place,
)
from navette.navigation.planning.planning_grid import PlanningGrid
from navette.navigation.planning.traversal import LETHAL, Cell
from navette.params.plugins import MethodFaultError, checked_array, own_call

_FARTHEST_M = 1e8
_SAME_PLACE_M = 1e-6


class Goal(NamedTuple):
    """Goal in the map frame; ``yaw`` None = any heading."""

    x: float
    y: float
    yaw: float | None = None


@dataclass(frozen=True, eq=False)
class PlannerGrid:
    """The map for a planner of the user; arrays are indexed [row, column] = [y, x].

    Attributes:
        occupancy: (H, W) int8, −1 unknown, 0 free … 100 occupied.
        distance_m: (H, W) float32, metres to the nearest occupied cell, clipped where
            more does not matter to the robot.
        blocked: (H, W) bool, where the base cannot be, whatever its heading.
        spec: geometry in the map frame.
    """

    occupancy: NDArray[np.int8]
    distance_m: NDArray[np.float32]
    blocked: NDArray[np.bool_]
    spec: GridSpec

    @classmethod
    def of(cls, occupancy: NDArray[np.int8], grid: PlanningGrid) -> "PlannerGrid":
        return cls(
            occupancy.copy(),
            grid.distances.everywhere(),
            grid.cost == LETHAL,
            grid.spec,
        )

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.spec.shape

    @property
    def resolution(self) -> float:
        """Edge of a cell, m."""
        return self.spec.resolution

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        """Return the (row, column) of a point (m, map)."""
        return self.spec.cell_of(x, y)

    def contains(self, row: int, column: int) -> bool:
        """Return whether a cell lies in the grid."""
        return self.spec.contains(row, column)

    def centers_of(self, cells: Any) -> NDArray[np.float64]:
        """Return the points (N, 2) x, y (m, map) of cells (N, 2) row, column."""
        return self.spec.centers_of(np.asarray(cells, np.int64).reshape(-1, 2))


class PlanMethod(Protocol):
    """A planner as a function of arrays."""

    def plan(self, grid: PlannerGrid, start: Pose2, goal: Goal) -> Any:
        """Return poses (N, 3) x, y, yaw or points (N, 2) from start to goal.

        None or nothing: no path exists.
        """


class OwnPlan:
    """Plans of a user's method; its faults raise MethodFaultError."""

    def __init__(self, params: PlannerParams, method: PlanMethod, name: str) -> None:
        self._params = params
        self._method = method
        self._name = f"planner {name}: plan(grid, start, goal)"

    def plan(self, grid: PlannerGrid, start: Pose2, goal: Goal) -> Poses | None:
        """Return poses (N, 3); points get the headings of their direction.

        Raises:
            MethodFaultError: the method raised, or returned something else.
        """
        returned = own_call(self._name, self._method.plan, grid, start, goal)
        if returned is None or (hasattr(returned, "__len__") and not len(returned)):
            return None
        expected = "poses (N, 3) x, y, yaw or points (N, 2), m, map; None: no path"
        path = checked_array(self._name, returned, expected, _is_path)
        self._check_ends(path, goal)
        if path.shape[1] == 3:
            return path
        return self._with_headings(path, start, goal)

    def _check_ends(self, path: NDArray[np.float64], goal: Goal) -> None:
        if np.abs(path[:, :2]).max() > _FARTHEST_M:
            raise MethodFaultError(f"{self._name} returned points beyond 1e8 m")
        off = math.dist(path[-1, :2], (goal.x, goal.y))
        if off > self._params.goal_tolerance_m:
            x, y = path[-1, :2]
            raise MethodFaultError(
                f"{self._name} returned a path that ends at ({x:.2f}, {y:.2f}), "
                f"{off:.2f} m from the goal ({goal.x:.2f}, {goal.y:.2f}); at most "
                f"goal_tolerance_m, {self._params.goal_tolerance_m:g} m (are x and y, "
                "or rows and columns, exchanged?)"
            )

    def _with_headings(
        self, points: NDArray[np.float64], start: Pose2, goal: Goal
    ) -> Poses:
        steps = np.hypot(*np.diff(points, axis=0).T)
        points = points[np.concatenate([[True], steps > _SAME_PLACE_M])]
        if len(points) == 1:
            poses = np.array([[*points[0], start.yaw]])
        else:
            poses = headed(resample(points, self._params.path_spacing_m))
        if goal.yaw is None:
            return poses
        x, y, yaw = poses[-1].tolist()
        return joined(poses, turn_in_place(x, y, yaw, goal.yaw))


SearchMethod = Callable[..., Any]
"""A user's ``search(cost, start, goal)``; what it returns is checked."""


class OwnSearch:
    """A user's search on the grid of costs; its faults raise MethodFaultError."""

    def __init__(self, search: SearchMethod, name: str) -> None:
        self._search = search
        self._name = f"planner {name}: search(cost, start, goal)"

    def search(
        self, cost: NDArray[np.uint8], start: Cell, goal: Cell, **_: object
    ) -> tuple[NDArray[np.int64], int] | None:
        """Return cells (N, 2) row, column from start to goal; None = no path."""
        returned = own_call(self._name, self._search, cost.copy(), start, goal)
        if returned is None or not len(returned):
            return None
        expected = "cells (N, 2) row, column"
        array = checked_array(
            self._name, returned, expected, lambda s: len(s) == 2 and s[1] == 2
        )
        cells = array.astype(np.int64)
        inside = ((cells >= 0) & (cells < cost.shape)).all(axis=1)
        if not inside.all():
            at = tuple(cells[~inside][0].tolist())
            raise MethodFaultError(
                f"{self._name} returned cell {at}, outside the grid of {cost.shape}"
            )
        ends = tuple(cells[0].tolist()), tuple(cells[-1].tolist())
        if ends != (tuple(start), tuple(goal)):
            raise MethodFaultError(
                f"{self._name} returned cells from {ends[0]} to {ends[1]}; expected "
                f"from {tuple(start)} to {tuple(goal)}"
            )
        return cells, 0


def _is_path(shape: tuple[int, ...]) -> bool:
    return len(shape) == 2 and shape[1] in (2, 3)
