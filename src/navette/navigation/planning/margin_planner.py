"""Plan with one clearance: the grid's route where the body fits, else a detour."""

import math
from dataclasses import dataclass, replace

from navette.geometry import OMNI, Pose2
from navette.navigation.planning.detour import DetourPlanner, DetourResult, Target
from navette.navigation.planning.fitted_route import RouteFitter
from navette.navigation.planning.goals import nearest_reachable
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.own_methods import Goal
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import Poses
from navette.navigation.planning.plan import Plan, cost_of
from navette.navigation.planning.planning_grid import PlanningGrid
from navette.navigation.planning.prepared_map import PreparedMap
from navette.navigation.planning.route import GridRouter
from navette.navigation.planning.traversal import LETHAL


@dataclass(frozen=True)
class MarginPlanner:
    """Planner on one map; start and goal lie in it.

    Attributes:
        params: parameters; their clearances are not used.
        map: the map.
        router: search for routes of a point.
        put_down_at: pose where the robot was put down; None: the start of each plan.
    """

    params: PlannerParams
    map: PreparedMap
    router: GridRouter
    put_down_at: Pose2 | None

    def plan(
        self,
        margin_m: float,
        start: Pose2,
        goal: Goal,
        *,
        max_expansions: int,
        below_m: float = math.inf,
    ) -> Plan:
        """Plan a path of which the body keeps a margin.

        A path that cannot cost less than ``below_m`` may not be found.
        """
        grid = self.map.opened(margin_m, start)
        route, why_not = self._route(grid, start, goal, below_m)
        if route is None:
            return Plan(why_not)
        fitter = RouteFitter(self.params, grid, self.map.body, goal)
        fitting = fitter.fit(start, route)
        if self.params.drive == OMNI and margin_m < self.params.clearance_margin_m:
            fitting = fitter.held(start, fitting)
        if fitting is not None and not fitter.ends_cramped(fitting):
            return self.planned(goal, fitting, margin_m)
        reach_m = path_end_reach_m(self.params)
        target = Target(goal.x, goal.y, goal.yaw, reach_m)
        detour = self._detours(grid, start, max_expansions).plan(start, target, route)
        poses = fitting if detour.poses is None else detour.poses
        if poses is None:
            return Plan(_why_none(detour), expansions=detour.expansions)
        return self.planned(goal, poses, margin_m, detour.expansions)

    def plan_on_grid(
        self, margin_m: float, start: Pose2, goal: Goal, below_m: float
    ) -> Plan | None:
        """Plan with the grid search alone; None without a path that costs less."""
        grid, body = self.map.opened(margin_m, start), self.map.body
        goal_xy = goal.x, goal.y
        route = self.router.route(grid, body, start, goal_xy, goal.yaw, below_m)
        if route is None:
            return None
        poses = RouteFitter(self.params, grid, body, goal).fit(start, route)
        return None if poses is None else self.planned(goal, poses, margin_m)

    def planned(
        self, goal: Goal, poses: Poses, margin_m: float, expansions: int = 0
    ) -> Plan:
        """Return the plan of a path, with its cost."""
        off = math.dist(poses[-1, :2], (goal.x, goal.y))
        snapped = off > self.params.path_end_tolerance_m
        outcome = Outcome.GOAL_SNAPPED if snapped else Outcome.OK
        cost = cost_of(poses, self.map.grid(), self.params)
        return Plan(outcome, poses, cost, margin_m, expansions)

    def _route(
        self, grid: PlanningGrid, start: Pose2, goal: Goal, below_m: float
    ) -> tuple[Poses | None, Outcome]:
        """Return the grid's route to the goal or near it, or None and the reason."""
        body = self.map.body
        route = self.router.route(
            grid, body, start, (goal.x, goal.y), goal.yaw, below_m
        )
        if route is not None:
            return route, Outcome.OK
        cell, end_cell = (grid.cell_of(at.x, at.y) for at in (start, goal))
        assert cell is not None, "the start lies in the map"
        assert end_cell is not None, "the goal lies in the map"
        if below_m < math.inf and grid.cost[end_cell] != LETHAL:
            return None, Outcome.NO_PATH
        reach_m = path_end_reach_m(self.params)
        near, outcome = nearest_reachable(grid, cell, (goal.x, goal.y), reach_m, body)
        if near is None:
            return None, outcome
        end = grid.spec.center_of(*near)
        route = self.router.route(grid, body, start, end, goal.yaw, below_m)
        return route, Outcome.NO_PATH if route is None else outcome

    def _detours(
        self, grid: PlanningGrid, start: Pose2, max_expansions: int
    ) -> DetourPlanner:
        params = replace(self.params, max_expansions=max_expansions)
        unseen = self.map.unseen(self.put_down_at or start)
        return DetourPlanner(grid, self.map.body, params, self.router, unseen)


def _why_none(detour: DetourResult) -> Outcome:
    """Return why no detour was found."""
    if detour.exhausted:
        return Outcome.SEARCH_LIMIT
    # Nothing but the start was expanded: no motion from there is free.
    return Outcome.START_BLOCKED if detour.expansions == 1 else Outcome.NO_PATH


def path_end_reach_m(params: PlannerParams) -> float:
    """Return the largest distance from the goal at which a path may end.

    Less than the tolerance, because the robot may stop before the path's end.
    """
    return max(
        params.goal_tolerance_m - params.path_end_tolerance_m,
        0.5 * params.goal_tolerance_m,
    )
