"""Plan a path that the footprint can drive, from map, pose and goal."""

import copy
import logging
import math
from dataclasses import replace

import numpy as np

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.planning.body_space import BodySpace
from navette.navigation.planning.connection import is_cut_off
from navette.navigation.planning.detour import DetourPlanner, Target
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.goals import nearest_reachable
from navette.navigation.planning.margin_planner import MarginPlanner
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.new_map import NewMap
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.own_methods import Goal, OwnPlan, PlannerGrid
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import Poses, turn_in_place
from navette.navigation.planning.plan import Plan, cost_of
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid
from navette.navigation.planning.prepared_map import PreparedMap
from navette.navigation.planning.route import GridRouter
from navette.navigation.planning.tight_places import (
    TightPlanner,
    quick_expansions,
    tight_margin_m,
)
from navette.navigation.planning.traversal import STRAIGHT, SearchGrid
from navette.params.plugins import MethodFaultError

__all__ = ["Goal", "Plan", "Planner"]

# A path longer than _LONG_WAY times the straight line plus _LONG_WAY_M is replaced by
# one with the tight margin that costs less than _SQUEEZE_SHARE of it.
_LONG_WAY, _LONG_WAY_M, _SQUEEZE_SHARE = 1.5, 4.0, 0.6
# Heading error at an exact start above which the path begins with a turn in place.
_EXACT_START_RAD = 0.1
# A robot as near to its goal stands there.
_AT_GOAL_M = 0.03
_log = logging.getLogger(__name__)


class Planner:
    """Planner on the newest map; stateless between plans.

    Attributes:
        map: the newest map.
        put_down_at: pose where the robot was put down; None: the start of each plan.
    """

    def __init__(self, params: PlannerParams) -> None:
        self.params = params
        self.router = GridRouter(params)
        self.map = PreparedMap(params)
        self.put_down_at: Pose2 | None = None
        self._own = _own_plan(params)

    def copy(self) -> "Planner":
        """Return a planner with the same map that changes independently."""
        other = copy.copy(self)
        other.map = self.map.copy()
        return other

    def with_params(self, params: PlannerParams) -> "Planner":
        """Return a planner with other parameters on the same map."""
        other = Planner(params)
        other.put_down_at = self.put_down_at
        if not self.map.is_empty:
            other.set_map(NewMap(self.map.cells, self.map.spec, self.map.hits))
        return other

    def set_map(self, new: NewMap) -> None:
        """Replace the map."""
        self.map.receive(new)

    @property
    def body(self) -> BodyShape:
        """The body, sampled at the map's resolution."""
        return self.map.body

    def grid(self) -> PlanningGrid:
        """Return the map prepared for the usual margin."""
        return self.map.grid()

    def warm_up(self) -> None:
        """Compile or load every kernel before the first goal."""
        reach = self.map.footprint.circumscribed_radius
        spec = GridSpec(reach / 4, 40, 40)
        own = PLANNERS.load(self.params.method).is_own  # is called for goals only
        other = Planner(replace(self.params, method="a_star") if own else self.params)
        other.set_map(NewMap(np.zeros(spec.shape, np.int8), spec))
        start, goal = Pose2(4 * reach, 5 * reach, 0.0), Goal(6 * reach, 5.1 * reach)
        other.plan(start, goal)
        unseen = other.map.unseen(start)
        DetourPlanner(other.grid(), other.body, self.params, other.router, unseen).plan(
            start, Target(goal.x, goal.y, None, reach), None
        )
        grid = other.grid()
        nearest_reachable(grid, (20, 20), (goal.x, goal.y), reach, other.body)
        cells = SearchGrid.of(grid.cost, grid.table)
        is_cut_off(cells, cells.index_of((20, 20)), cells.index_of((0, 0)), 1)
        nothing, body = np.zeros(spec.shape, np.bool_), self.map.footprint
        space = BodySpace(nothing, spec, body, start)
        space.reached_from(np.array([space.start]))

    def plan(
        self,
        start: Pose2,
        goal: Goal,
        *,
        exact_start: bool = False,
        more_margin_m: float = 0.0,
    ) -> Plan:
        """Plan from ``start`` to ``goal``; without a path the outcome names the reason.

        If the body does not fit with its margin, or only on a long detour, the tight
        margin is tried. With ``exact_start`` the path begins with the heading of the
        start: a robot between obstacles cannot steer towards another heading.
        ``more_margin_m`` is added to the tight margin and to the least one.
        """
        if exact_start and self._own is None:
            other = self.copy()
            other.params = replace(self.params, turn_threshold_rad=_EXACT_START_RAD)
            other.router = self.router.with_params(other.params)
            return other.plan(start, goal, more_margin_m=more_margin_m)
        refused = self._refusal(start, goal)
        if refused is not None:
            return Plan(refused)
        try:
            if self._own is not None:
                return self._plan_own(self._own, start, goal)
            turn = self._plan_turn(start, goal)
            if turn is not None:
                return turn
            before = self.router.expanded
            plan = self._plan_or_squeeze(start, goal, more_margin_m)
            return replace(plan, cells=self.router.expanded - before)
        except MethodFaultError as error:
            return Plan(Outcome.METHOD_FAILED, fault=str(error))

    def plan_on_grid(
        self, start: Pose2, goal: Goal, below_m: float = math.inf
    ) -> Plan | None:
        """Plan with the grid search alone and the full margin; None without a path.

        This is cheap, to look for a better path while one is being driven: one that
        cannot cost less than ``below_m`` may not be found.
        """
        if self._refusal(start, goal) is not None or self._own is not None:
            return None
        margin = self.params.clearance_margin_m
        try:
            return self._with_margin.plan_on_grid(margin, start, goal, below_m)
        except MethodFaultError as error:
            _log.warning("no better path, the present one is kept: %s", error)
            return None

    def least_cost(self, start: Pose2, goal: Goal) -> float:
        """Return a lower bound on the cost of a path within the goal's tolerance."""
        grid = self.grid()
        begin, end = grid.cell_of(start.x, start.y), grid.cell_of(goal.x, goal.y)
        if begin is None or end is None:
            return 0.0
        most = float(grid.table.straight[grid.costs.unknown]) / STRAIGHT
        slack = self.params.goal_tolerance_m + grid.spec.resolution
        return grid.least_cost_m(begin, end) - max(most, 1.0) * slack

    def cost_of(self, poses: Poses) -> float:
        """Return the cost of these poses on the newest map; see path_cost."""
        return cost_of(poses, self.grid(), self.params)

    def _refusal(self, start: Pose2, goal: Goal) -> Outcome | None:
        """Return why nothing is planned; the map is enlarged to hold start and goal.

        A robot far from the middle of the first map may get a goal before its first
        costmap is in the map.
        """
        if not all(map(math.isfinite, (goal.x, goal.y, goal.yaw or 0.0))):
            return Outcome.GOAL_NOT_FINITE
        self.map.hold(goal.x, goal.y)
        self.map.hold(start.x, start.y)
        if self.grid().cell_of(goal.x, goal.y) is None:
            return Outcome.GOAL_OUTSIDE_MAP
        if self.grid().cell_of(start.x, start.y) is None:
            return Outcome.START_OUTSIDE_MAP
        return None

    def _plan_own(self, own: OwnPlan, start: Pose2, goal: Goal) -> Plan:
        """Plan with the user's method; the path is driven as it is."""
        margin = tight_margin_m(self.params)
        grid = PlannerGrid.of(self.map.cells, self.map.opened(margin, start))
        poses = own.plan(grid, start, goal)
        if poses is None:
            return Plan(Outcome.NO_PATH)
        return self._with_margin.planned(goal, poses, margin)

    def _plan_turn(self, start: Pose2, goal: Goal) -> Plan | None:
        """Plan no more than a turn in place for a robot that stands at the goal.

        Its direction to the goal is noise. A behaviour tree that plans every second
        would have the robot turn there for ever. None: it does not, or cannot turn.
        """
        off = math.dist((start.x, start.y), (goal.x, goal.y))
        if off > _AT_GOAL_M or not self.params.turns_in_place:
            return None
        yaw = start.yaw if goal.yaw is None else goal.yaw
        poses = turn_in_place(start.x, start.y, start.yaw, yaw)
        margin = tight_margin_m(self.params)
        if not check_path(poses, self.map.opened(margin, start), self.body).fits:
            return None
        return self._with_margin.planned(goal, poses, margin)

    def _plan_or_squeeze(self, start: Pose2, goal: Goal, more_margin_m: float) -> Plan:
        """Plan with the usual margin, else the tight one, else on finer cells."""
        params = self.params
        planner, quick = self._with_margin, quick_expansions(params)
        usual, tight = params.clearance_margin_m, tight_margin_m(params, more_margin_m)
        plan = planner.plan(usual, start, goal, max_expansions=quick)
        direct = math.dist((start.x, start.y), (goal.x, goal.y))
        if plan.outcome.has_path and plan.cost <= _LONG_WAY * direct + _LONG_WAY_M:
            return plan
        if tight < usual:
            worth = _SQUEEZE_SHARE * plan.cost
            squeezed = planner.plan(
                tight, start, goal, max_expansions=quick, below_m=worth
            )
            if squeezed.outcome.has_path and squeezed.cost < worth:
                plan = squeezed
        if plan.outcome.has_path:
            return plan
        return TightPlanner(
            params, self.map, self.put_down_at, start, goal, more_margin_m=more_margin_m
        ).plan(plan)

    @property
    def _with_margin(self) -> MarginPlanner:
        return MarginPlanner(self.params, self.map, self.router, self.put_down_at)


def _own_plan(params: PlannerParams) -> OwnPlan | None:
    """Return the user's planner; None if the method is a search."""
    method = PLANNERS.load(params.method)
    if method.entry != "plan":
        return None
    return OwnPlan(params, method.make(params), method.name)
