"""A route on the grid: search, straighten, smooth, add headings; for a point robot."""

import copy
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.navigation.planning.astar import AStar
from navette.navigation.planning.centring import centred
from navette.navigation.planning.footprint_check import clearances
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.own_methods import OwnSearch
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import (
    Poses,
    headed,
    joined,
    resample,
    smooth,
    turn_in_place,
)
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid
from navette.navigation.planning.string_pulling import centers, pull
from navette.navigation.planning.traversal import STRAIGHT

# Largest cost of a path of cells, compared with that of the line pulled from it.
_PULL_RATIO = 1.15
# Above this angle both directions of a turn are of similar length.
_NEARLY_HALF_TURN = 2.4

_Search = Callable[..., tuple[NDArray[np.int64], int] | None]


def _make_search(params: PlannerParams) -> _Search:
    """Return the search of ``params.method``; A* if that is not a search."""
    method = PLANNERS.load(params.method)
    if method.entry != "search":
        return AStar().search
    search: _Search = method.make(params).search
    return OwnSearch(search, method.name).search if method.is_own else search


class GridRouter:
    """Plan the path of a point through a grid and add headings.

    ``centres``: move the path to the middle of tight places, which takes longer.
    """

    def __init__(self, params: PlannerParams, *, centres: bool = False) -> None:
        self.params = params
        self.centres = centres
        self._search = _make_search(params)
        owner = getattr(self._search, "__self__", None)
        self._a_star = owner if isinstance(owner, AStar) else None

    def with_params(self, params: PlannerParams) -> "GridRouter":
        """Return a router with other parameters that uses the same search."""
        other = copy.copy(self)
        other.params = params
        return other

    @property
    def expanded(self) -> int:
        """Number of cells that A* has expanded for all routes."""
        return 0 if self._a_star is None else self._a_star.expanded

    def route(
        self,
        grid: PlanningGrid,
        body: BodyShape,
        start: Pose2,
        goal_xy: tuple[float, float],
        goal_yaw: float | None = None,
        below_m: float = math.inf,
    ) -> Poses | None:
        """Return poses (N, 3) from the start pose to the goal; None without a path.

        A path that cannot cost less than ``below_m`` metres of free driving may not be
        found.

        Start and goal lie in the grid. The path begins with a turn in place if the
        heading error exceeds the threshold, and ends with one to ``goal_yaw``.
        """
        cells = self._cells(grid, (start.x, start.y), goal_xy, below_m)
        if cells is None:
            return None
        ends = np.array([(start.x, start.y), goal_xy])
        line = centers(cells)
        # The ends keep their exact positions instead of their cells' centres.
        line = np.concatenate([grid.to_cells(ends[:1]), line[1:-1],
                               grid.to_cells(ends[1:])])  # fmt: skip
        line = grid.to_metres(pull(grid.cost, line, table=grid.table))
        line[0], line[-1] = ends
        return self._with_headings(line, grid, body, start, goal_yaw)

    def _cells(
        self,
        grid: PlanningGrid,
        start_xy: tuple[float, float],
        goal_xy: tuple[float, float],
        below_m: float,
    ) -> NDArray[np.int64] | None:
        start, goal = grid.cell_of(*start_xy), grid.cell_of(*goal_xy)
        assert start is not None, "the start lies in the grid"
        assert goal is not None, "the goal lies in the grid"
        if self._a_star is None:
            found = self._search(grid.cost, start, goal, table=grid.table)
        else:
            # A path of cells is longer than the one that is pulled from it.
            bound = _PULL_RATIO * below_m / grid.spec.resolution * STRAIGHT
            found = self._a_star.search(
                grid.cost,
                start,
                goal,
                table=grid.table,
                bound=bound,
                cheap=grid.cheap,
            )
        return None if found is None else found[0]

    def _with_headings(
        self,
        line: NDArray[np.float64],
        grid: PlanningGrid,
        body: BodyShape,
        start: Pose2,
        goal_yaw: float | None,
    ) -> Poses:
        spacing = self.params.path_spacing_m
        here = np.array([[start.x, start.y, start.yaw]])
        if math.dist(line[0], line[-1]) < 1e-3:
            poses = here
        else:
            keep_m = body.circumscribed_m + grid.margin_m
            line = smooth(resample(line, spacing), grid, keep_m)
            if self.centres:
                line = centred(line, grid, body)
            poses = headed(resample(line, spacing))
            if self.turns_first(start, poses):
                poses = joined(self._turn(grid, body, start, poses[0, 2]), poses)
        if goal_yaw is None:
            return poses
        x, y, yaw = poses[-1].tolist()
        return joined(poses, self._turn(grid, body, Pose2(x, y, yaw), goal_yaw))

    def _turn(
        self, grid: PlanningGrid, body: BodyShape, at: Pose2, to_yaw: float
    ) -> Poses:
        """Return a turn in place: the shorter, or the longer if it has more room."""
        short = turn_in_place(at.x, at.y, at.yaw, to_yaw)
        if abs(angle_difference(to_yaw, at.yaw)) < _NEARLY_HALF_TURN:
            return short
        comfort = grid.margin_m + self.params.comfort_m
        room = clearances(short, grid, body, enough_m=comfort).min()
        if room >= comfort:
            return short
        long = turn_in_place(at.x, at.y, at.yaw, to_yaw, long_way=True)
        round_room = clearances(long, grid, body, enough_m=comfort).min()
        return long if round_room > room + grid.spec.resolution / 2 else short

    def turns_first(self, start: Pose2, poses: Poses) -> bool:
        """Return whether the robot must turn in place before it follows the poses."""
        error = angle_difference(float(poses[0, 2]), start.yaw)
        return abs(error) > self.params.turn_threshold_rad
