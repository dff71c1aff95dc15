"""Fit the grid's route, planned for a point, to the body that drives it."""

import math
from dataclasses import dataclass

import numpy as np

from navette.geometry import Pose2, wrap_angles
from navette.navigation.planning.footprint_check import check_path, clearances
from navette.navigation.planning.own_methods import Goal
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import Poses, lengths, turn_in_place
from navette.navigation.planning.plan import cost_of
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid

# Share of the goal tolerance by which a route may be shortened.
_CUT_SHARE = 0.5
# Clearance at the path's end in margins: a robot stops slightly early or late.
_ROOMY_END = 2.0
# Least difference between the length of a bend and the turn times the least radius.
_STEERABLE_M = 0.02


@dataclass(frozen=True)
class RouteFitter:
    """Shortens routes to one goal on one grid until the body fits along them."""

    params: PlannerParams
    grid: PlanningGrid
    body: BodyShape
    goal: Goal

    def fit(self, start: Pose2, route: Poses) -> Poses | None:
        """Return the route, shortened slightly if needed, if the body fits along it."""
        if not self.params.turns_in_place and not self._is_steerable(start, route):
            return None
        sweep = turn_in_place(start.x, start.y, start.yaw, float(route[0, 2]))
        check = check_path(np.concatenate([sweep, route]), self.grid, self.body)
        if check.first_bad is None:
            return self._cut_for_comfort(route)
        kept = route[: max(0, check.first_bad - len(sweep))]
        if self.goal.yaw is not None or len(kept) < 2:
            return None
        missing = math.dist(kept[-1, :2], (self.goal.x, self.goal.y))
        if missing > _CUT_SHARE * self.params.goal_tolerance_m:
            return None
        return self._cut_for_comfort(kept)

    def held(self, start: Pose2, route: Poses | None) -> Poses | None:
        """Return the route driven without turning, if the body fits and it costs less.

        An omnidirectional robot need not turn where there is hardly room for it.
        """
        if route is None:
            return None
        poses = np.column_stack([route[:, :2], np.full(len(route), start.yaw)])
        poses = poses[np.append(True, np.any(np.diff(poses[:, :2], axis=0), axis=1))]
        if self.goal.yaw is not None:
            x, y, yaw = poses[-1].tolist()
            poses = np.concatenate([poses, turn_in_place(x, y, yaw, self.goal.yaw)])
        fits = check_path(poses, self.grid, self.body).fits
        return poses if fits and self._cost(poses) < self._cost(route) else route

    def ends_cramped(self, route: Poses) -> bool:
        """Return whether a robot that stops slightly late would be too close."""
        last = clearances(route[-1:], self.grid, self.body)
        return bool(last[0] < _ROOMY_END * self.grid.margin_m)

    def _cost(self, poses: Poses) -> float:
        return cost_of(poses, self.grid, self.params)

    def _is_steerable(self, start: Pose2, route: Poses) -> bool:
        """Return whether an Ackermann drive can follow the route from the start."""
        yaws = np.concatenate([[start.yaw], route[:, 2]])
        turned = np.abs(wrap_angles(np.diff(yaws)))
        driven = np.concatenate([[0.0], lengths(route)])
        radius = self.params.min_turning_radius_m
        return bool(np.all(turned * radius <= driven + _STEERABLE_M))

    def _cut_for_comfort(self, route: Poses) -> Poses:
        """Shorten the route to an end with more clearance, if that is near enough."""
        away = np.hypot(route[:, 0] - self.goal.x, route[:, 1] - self.goal.y)
        near = away <= _CUT_SHARE * self.params.goal_tolerance_m
        first = len(route) - int(np.argmin(near[::-1])) if not near.all() else 1
        tail = route[first:]
        if self.goal.yaw is not None or not len(tail):
            return route
        roomy = clearances(tail, self.grid, self.body) >= (
            _ROOMY_END * self.grid.margin_m
        )
        if not roomy.any():
            return route
        return route[: first + int(np.flatnonzero(roomy)[-1]) + 1]
