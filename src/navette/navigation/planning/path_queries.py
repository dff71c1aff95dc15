"""Paths as answers to requests; the goal that is being driven is not affected."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.planning.footprint_check import clearances
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.path_shape import Poses, joined
from navette.navigation.planning.planner import Goal, Planner


@dataclass(frozen=True)
class PlannedRoute:
    """Path through several goals.

    Attributes:
        outcome: of the first leg without a path, or of the last leg.
        poses: (N, 3) x, y, yaw in the map frame; empty without a path.
        leg: index of the last planned leg.
        fault: error of a user's method; empty without one.
    """

    outcome: Outcome
    poses: Poses = field(default_factory=lambda: np.empty((0, 3)))
    leg: int = 0
    fault: str = ""


def plan_through(planner: Planner, start: Pose2, goals: Sequence[Goal]) -> PlannedRoute:
    """Plan from the start through all goals in order.

    Each leg begins where the previous one ends, which may be beside an unreachable
    goal, within the tolerance.
    """
    if not all(map(math.isfinite, start)):
        return PlannedRoute(Outcome.START_OUTSIDE_MAP)
    legs: list[Poses] = []
    outcome = Outcome.NO_PATH
    for index, goal in enumerate(goals):
        plan = planner.plan(start, goal)
        outcome = plan.outcome
        if not outcome.has_path:
            return PlannedRoute(outcome, leg=index, fault=plan.fault)
        legs.append(plan.poses)
        start = Pose2(*plan.poses[-1].tolist())
    return PlannedRoute(outcome, joined(*legs), len(goals) - 1)


def blocked_poses(
    planner: Planner, poses: Poses, robot: Pose2 | None
) -> NDArray[np.int64]:
    """Return the indices of the poses (N, 3) at which the body is not clear.

    A body is not clear if it touches an obstacle or its base lies outside the map. The
    poses before the one nearest to the robot are not checked: they have been driven.
    """
    first = 0
    if robot is not None:
        away = np.hypot(poses[:, 0] - robot.x, poses[:, 1] - robot.y)
        first = int(np.argmin(away))
    grid = planner.grid()
    clear = clearances(poses[first:], grid, planner.body, enough_m=0.0) >= 0.0
    uv = grid.to_cells(poses[first:, :2])
    inside = np.all((uv >= 0) & (uv < (grid.spec.width, grid.spec.height)), axis=1)
    return first + np.flatnonzero(~(clear & inside))
