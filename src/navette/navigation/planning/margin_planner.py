"""Plan with one clearance: the grid's route where the body fits, else a detour."""

import math
from dataclasses import dataclass, replace

from navette.geometry import OMNI, Pose2
from navette.navigation.planning.body_reach import BodyReach
from navette.navigation.planning.body_space import ALL_POSES, OpenPoses
from navette.navigation.planning.detour import DetourPlanner, DetourResult, Target
from navette.navigation.planning.fitted_route import RouteFitter
from navette.navigation.planning.goals import nearest_reachable, path_end_reach_m
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.own_methods import Goal
from navette.navigation.planning.params import LEAST_EXPANSIONS, PlannerParams
from navette.navigation.planning.path_shape import Poses
from navette.navigation.planning.plan import Plan, cost_of
from navette.navigation.planning.planning_grid import PlanningGrid
from navette.navigation.planning.prepared_map import PreparedMap
from navette.navigation.planning.route import GridRouter

# Expansions before the search is restricted to where the body can be, which takes as
# long as thousands of them.
FIRST_EXPANSIONS = 1_000
# Part of the budget then: paths are found with little of it, or by all motions.
_GUIDED_SHARE = 4


@dataclass(frozen=True)
class MarginPlanner:
    """Planner on one map; start and goal lie in it.

    Attributes:
        params: parameters; their clearances are not used.
        map: the map.
        router: search for routes of a point.
        put_down_at: pose where the robot was put down; None: the start of each plan.
        reach: where the body can be, for long searches; None: they are not restricted.
        poses: that may have the margin.
    """

    params: PlannerParams
    map: PreparedMap
    router: GridRouter
    put_down_at: Pose2 | None
    reach: BodyReach | None = None
    poses: OpenPoses = ALL_POSES

    def plan(
        self, margin_m: float, start: Pose2, goal: Goal, *, max_expansions: int
    ) -> Plan:
        """Plan a path of which the body keeps a margin."""
        grid = self.map.opened(margin_m, start)
        route, why_not = self._route(grid, start, goal)
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
        first = max_expansions if self.reach is None else FIRST_EXPANSIONS
        first = min(first, max_expansions)
        detour = self._detours(grid, start, first).plan(start, target, route)
        if self.reach is not None and detour.poses is None and detour.exhausted:
            if self.reach.possible(margin_m).has_goal:
                return self._plan_within(self.reach, margin_m, max_expansions)
            detour = replace(detour, exhausted=False)
        poses = fitting if detour.poses is None else detour.poses
        if poses is None:
            return Plan(_why_none(detour), expansions=detour.expansions)
        return self.planned(goal, poses, margin_m, detour.expansions)

    def _plan_within(
        self, reach: BodyReach, margin_m: float, max_expansions: int
    ) -> Plan:
        """Plan where the body can be; a gap that it cannot pass attracts the search.

        Where the body may pass or not, only less than the usual margin is tried.
        """
        is_usual = margin_m >= self.params.clearance_margin_m
        within = reach.certain(margin_m)
        if not within.has_goal and is_usual:
            return Plan(Outcome.SEARCH_LIMIT)
        within = within if within.has_goal else reach.possible(margin_m)
        budget = max(LEAST_EXPANSIONS, max_expansions // _GUIDED_SHARE)
        planner = replace(
            self,
            map=self.map.restricted(reach.on_map(within.cells)),
            reach=None,
            poses=reach.possible_space(margin_m).poses,
        )
        return planner.plan(margin_m, reach.start, reach.goal, max_expansions=budget)

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
        self, grid: PlanningGrid, start: Pose2, goal: Goal
    ) -> tuple[Poses | None, Outcome]:
        """Return the grid's route to the goal or near it, or None and the reason."""
        body = self.map.body
        route = self.router.route(grid, body, start, (goal.x, goal.y), goal.yaw)
        if route is not None:
            return route, Outcome.OK
        cell = grid.cell_of(start.x, start.y)
        assert cell is not None, "the start lies in the map"
        reach_m = path_end_reach_m(self.params)
        near, outcome = nearest_reachable(grid, cell, (goal.x, goal.y), reach_m, body)
        if near is None:
            return None, outcome
        end = grid.spec.center_of(*near)
        route = self.router.route(grid, body, start, end, goal.yaw)
        assert route is not None, "the end was chosen among reachable cells"
        return route, outcome

    def _detours(
        self, grid: PlanningGrid, start: Pose2, max_expansions: int
    ) -> DetourPlanner:
        params = replace(self.params, max_expansions=max_expansions)
        unseen = self.map.unseen(self.put_down_at or start)
        return DetourPlanner(
            grid, self.map.body, params, self.router, unseen, poses=self.poses
        )


def _why_none(detour: DetourResult) -> Outcome:
    """Return why no detour was found."""
    if detour.exhausted:
        return Outcome.SEARCH_LIMIT
    # Nothing but the start was expanded: no motion from there is free.
    return Outcome.START_BLOCKED if detour.expansions == 1 else Outcome.NO_PATH
