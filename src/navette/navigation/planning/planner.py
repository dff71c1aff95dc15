"""Plan a path that the footprint can drive, from map, pose and goal."""

import copy
import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from navette.geometry import OMNI, Footprint, Pose2
from navette.navigation.grids import (
    NO_DISCS,
    UNKNOWN,
    CellWindow,
    GridSpec,
    Layer,
    StartArea,
    exact_clearances,
    make_outline,
    unseen_mask,
)
from navette.navigation.planning.body_space import BodySpace
from navette.navigation.planning.close_look import CloseMap, close_map
from navette.navigation.planning.detour import DetourPlanner, Target
from navette.navigation.planning.footprint_check import check_path, clearances
from navette.navigation.planning.goals import cells_near, nearest_reachable
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.moving_cost import with_moving
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.own_methods import Goal, OwnPlan, PlannerGrid
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import (
    Poses,
    lengths,
    path_cost,
    turn_in_place,
)
from navette.navigation.planning.planning_grid import (
    NO_HITS,
    BodyShape,
    PlanningGrid,
    open_at,
    planning_grid,
    update_grid,
    without_obstacles_in,
)
from navette.navigation.planning.planning_map import PlanningMap
from navette.navigation.planning.route import GridRouter
from navette.navigation.planning.traversal import STRAIGHT
from navette.params.plugins import MethodFaultError

__all__ = ["Goal", "Plan", "Planner"]

# Share of the goal tolerance by which a route may be shortened.
_CUT_SHARE = 0.5
# A path longer than _LONG_WAY times the straight line plus _LONG_WAY_M is replaced by
# one with the tight margin that costs less than _SQUEEZE_SHARE of it.
_LONG_WAY, _LONG_WAY_M, _SQUEEZE_SHARE = 1.5, 4.0, 0.6
# Heading error at an exact start above which the path begins with a turn in place.
_EXACT_START_RAD = 0.1
# Clearance at the path's end in margins: a robot stops slightly early or late.
_ROOMY_END = 2.0
# Least difference between the length of a bend and the turn times the least radius.
_STEERABLE_M = 0.02
# A robot as near to its goal stands there.
_AT_GOAL_M = 0.03
# Searches on the map's own cells, and through gaps, get this part of the budget.
_QUICK_SHARE = 4
# In a passage the clearance varies by this, and is not planned below the least, which
# is what the controller keeps: it would refuse a path with less.
_SWAY_M, _LEAST_M = 0.01, 0.025


@dataclass(frozen=True)
class Plan:
    """Result of planning.

    Attributes:
        outcome: named result.
        poses: (N, 3) x, y, yaw in the map frame; empty without a path.
        cost: cost of the path in metres of free driving forward.
        margin_m: clearance that the path keeps.
        expansions: poses expanded by the search with headings; 0 = not used.
        fault: error of a user's method; empty without one.
    """

    outcome: Outcome
    poses: Poses = field(default_factory=lambda: np.empty((0, 3)))
    cost: float = math.inf
    margin_m: float = math.nan
    expansions: int = 0
    fault: str = ""


class Planner:
    """Planner on the newest map; stateless between plans."""

    def __init__(self, params: PlannerParams) -> None:
        self.params = params
        self.footprint = Footprint.from_flat(params.footprint_m)
        self.router = GridRouter(params)
        self._own = _own_plan(params)
        self._map: PlanningMap | None = None
        self._hits = NO_HITS
        self._body: BodyShape | None = None
        self._resolution = 0.0
        self._some_cost_fell = True
        self._grids: dict[float, PlanningGrid] = {}
        self._moving = NO_DISCS
        self._moved: dict[float, PlanningGrid] = {}  # grids with what moves
        #: Pose where the robot was put down; None: that of the start of each plan.
        self.put_down_at: Pose2 | None = None

    def copy(self) -> "Planner":
        """Return a planner with the same map that changes independently."""
        other = copy.copy(self)
        other._map = copy.copy(self._map)
        other._grids = self._grids.copy()
        other._moved = self._moved.copy()
        return other

    def detach(self) -> None:
        """Take arrays of its own: copies of this planner keep what they have."""
        if self._map is not None:
            self._map = self._map.copy()
        self._grids = {margin: grid.copy() for margin, grid in self._grids.items()}

    def with_params(self, params: PlannerParams) -> "Planner":
        """Return a planner with other parameters on the same map."""
        other = Planner(params)
        other.put_down_at = self.put_down_at
        if self._map is not None:
            other.set_map(self._map.cells, self._map.spec, self._hits)
        return other

    def set_map(
        self,
        occupancy: NDArray[np.int8],
        spec: GridSpec,
        hits: NDArray[np.float64] = NO_HITS,
        changed: CellWindow | None = None,
    ) -> None:
        """Replace the map (H, W): −1 unknown, 0 free … 100 occupied.

        Args:
            occupancy: the array may be that of the last call.
            spec: its geometry.
            hits: (N, 2), map frame, m: where beams ended within its lethal cells.
            changed: the cells that changed since the last call; None: not known.
        """
        if self._body is None or self._resolution != spec.resolution:
            self._body = BodyShape.of(self.footprint, spec.resolution)
            self._resolution = spec.resolution
        self._hits = hits
        self._moved.clear()
        window = None
        if self._map is None:
            self._map = PlanningMap(occupancy, spec)
        else:
            window = self._map.receive(occupancy, spec, changed)
        if window is None:
            self._grids.clear()
            self._some_cost_fell = True
        else:
            self._update_grids(window)

    def _update_grids(self, window: CellWindow) -> None:
        """Change the grid of the usual margin; others are prepared again on demand."""
        assert self._map is not None, "called with a map"
        margin = self.params.clearance_margin_m
        grid = self._grids.get(margin)
        self._grids.clear()
        if grid is None:
            self._some_cost_fell = True
            return
        self._grids[margin], fell = update_grid(
            grid, self._map.cells, window, self.params.lethal_cost, self._hits
        )
        self._some_cost_fell |= fell

    def hold(self, goal: Goal) -> None:
        """Enlarge the map to hold a goal, within ``max_size_m``."""
        if self._map is None or not all(map(math.isfinite, (goal.x, goal.y))):
            return
        if self._map.hold(goal.x, goal.y, self.params.max_size_m):
            self._grids.clear()
            self._moved.clear()

    def take_cost_fall(self) -> bool:
        """Return whether a cost in the map fell since the last call."""
        fell, self._some_cost_fell = self._some_cost_fell, False
        return fell

    def set_moving(self, discs: NDArray[np.float64]) -> None:
        """Replace the moving obstacles (M, 5) x, y, vx, vy, radius; map, now."""
        if len(discs) or len(self._moving):
            self._moving = discs
            self._moved.clear()
            self._some_cost_fell = True

    def warm_up(self) -> None:
        """Compile or load every kernel before the first goal."""
        reach = self.footprint.circumscribed_radius
        spec = GridSpec(reach / 4, 40, 40)
        own = PLANNERS.load(self.params.method).is_own  # is called for goals only
        other = Planner(replace(self.params, method="a_star") if own else self.params)
        other.set_map(np.zeros(spec.shape, np.int8), spec)
        start, goal = Pose2(4 * reach, 5 * reach, 0.0), Goal(6 * reach, 5.1 * reach)
        other.plan(start, goal)
        unseen = other._unseen(start)
        DetourPlanner(other.grid(), other.body, self.params, other.router, unseen).plan(
            start, Target(goal.x, goal.y, None, reach), None
        )
        nearest_reachable(other.grid(), (20, 20), (goal.x, goal.y), reach, other.body)
        space = BodySpace(np.zeros(spec.shape, np.bool_), spec, self.footprint, start)
        space.reached_from(np.array([space.start]))

    @property
    def body(self) -> BodyShape:
        """The body, sampled at the map's resolution."""
        assert self._body is not None, "set_map comes first"
        return self._body

    def grid(self, margin_m: float | None = None) -> PlanningGrid:
        """Return the map prepared for a margin (default: clearance_margin_m)."""
        assert self._map is not None, "set_map comes first"
        margin = self.params.clearance_margin_m if margin_m is None else margin_m
        if margin not in self._grids:
            params = replace(self.params, clearance_margin_m=margin)
            self._grids[margin] = planning_grid(
                self._map.cells, self._map.spec, self.body, params, self._hits
            )
        if not len(self._moving):
            return self._grids[margin]
        if margin not in self._moved:
            self._moved[margin] = with_moving(
                self._grids[margin],
                self._moving,
                self.params.moving_horizon_s,
                self.body.inscribed_m,
            )
        return self._moved[margin]

    def plan(self, start: Pose2, goal: Goal, *, exact_start: bool = False) -> Plan:
        """Plan from ``start`` to ``goal``; without a path the outcome names the reason.

        If the body does not fit with its margin, or only on a long detour, the tight
        margin is tried. With ``exact_start`` the path begins with the heading of the
        start: a robot between obstacles cannot steer towards another heading.
        """
        if exact_start and self._own is None:
            other = self.copy()
            other.params = replace(self.params, turn_threshold_rad=_EXACT_START_RAD)
            other.router = self.router.with_params(other.params)
            return other.plan(start, goal)
        self.hold(goal)
        refused = self._refusal(start, goal)
        if refused is not None:
            return Plan(refused)
        try:
            if self._own is not None:
                return self._plan_own(self._own, start, goal)
            turn = self._plan_turn(start, goal)
            return self._plan_or_squeeze(start, goal) if turn is None else turn
        except MethodFaultError as error:
            return Plan(Outcome.METHOD_FAILED, fault=str(error))

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
        margin = self._tight_m
        fits = check_path(poses, self._opened(margin, start), self.body)
        return (
            None
            if fits.first_bad is not None
            else self._planned(goal, poses, margin, 0)
        )

    def _plan_own(self, own: OwnPlan, start: Pose2, goal: Goal) -> Plan:
        """Plan with the user's method; the path is driven as it is."""
        assert self._map is not None, "set_map comes first"
        margin = min(self.params.tight_margin_m, self.params.clearance_margin_m)
        grid = PlannerGrid.of(self._map.cells, self._opened(margin, start))
        poses = own.plan(grid, start, goal)
        if poses is None:
            return Plan(Outcome.NO_PATH)
        return self._planned(goal, poses, margin, 0)

    def _plan_or_squeeze(self, start: Pose2, goal: Goal) -> Plan:
        quick = self._quick
        plan = self._plan_with(
            self.params.clearance_margin_m, start, goal, max_expansions=quick
        )
        direct = math.dist((start.x, start.y), (goal.x, goal.y))
        if plan.outcome.has_path and plan.cost <= _LONG_WAY * direct + _LONG_WAY_M:
            return plan
        tight = self._tight_m
        if tight < self.params.clearance_margin_m:
            squeezed = self._plan_with(tight, start, goal, max_expansions=quick)
            worth = squeezed.cost < _SQUEEZE_SHARE * plan.cost
            plan = squeezed if squeezed.outcome.has_path and worth else plan
        return plan if plan.outcome.has_path else self._look_closer(start, goal, plan)

    @property
    def _quick(self) -> int:
        """Budget of a search before the proof that no path exists."""
        return self.params.max_expansions // _QUICK_SHARE

    @property
    def _tight_m(self) -> float:
        return min(self.params.tight_margin_m, self.params.clearance_margin_m)

    def _look_closer(self, start: Pose2, goal: Goal, plan: Plan) -> Plan:
        """Plan on finer cells where no path was found on the map's own cells.

        Returns ``plan``, with the reason why no path exists if that is proven.
        """
        assert self._map is not None, "set_map comes first"
        occupancy, spec = self._map.cells, self._map.spec
        ends = np.array([(start.x, start.y), (goal.x, goal.y)])
        reach_m = 2 * self.body.circumscribed_m
        closer = close_map(
            occupancy, spec, self._hits, self.params.lethal_cost, ends, reach_m
        )
        why = self._why_impossible(closer, start, goal)
        if why is not None:
            known = plan.outcome in (Outcome.START_BLOCKED, Outcome.GOAL_BLOCKED)
            return plan if known else replace(plan, outcome=why)
        slack = closer.spec.resolution
        margin = self._margin_from(start)
        body = BodyShape.of(self.footprint, slack)
        found = self._on_close_map(closer, body.through_gaps(slack))._plan_with(
            margin, start, goal, max_expansions=self._quick
        )
        if found.outcome.has_path:
            return found
        # The long search runs only if a path of exact poses at cell centres may exist.
        if self._why_impossible(closer, start, goal, 0.0) is None:
            found = self._on_close_map(closer, body.loose(slack))._plan_with(
                margin, start, goal, max_expansions=self.params.max_expansions
            )
        if found.outcome is not Outcome.SEARCH_LIMIT:
            return found
        why = self._why_impossible(closer, start, goal, margin)
        return found if why is None else replace(found, outcome=Outcome.NO_PATH)

    def _margin_from(self, start: Pose2) -> float:
        """Return the tight margin, or less in a passage where the robot has less."""
        pose = np.array([[start.x, start.y, start.yaw]])
        obstacles, outline = self.grid().exact_obstacles, make_outline(self.footprint)
        tight = self._tight_m
        here = float(exact_clearances(obstacles, outline, pose, tight + _SWAY_M)[0])
        return min(tight, max(here - _SWAY_M, _LEAST_M))

    def _on_close_map(self, closer: CloseMap, body: BodyShape) -> "Planner":
        other = Planner(self.params)
        other.router = GridRouter(self.params, centres=True)
        other.set_map(closer.occupancy, closer.spec, self._hits)
        other.put_down_at = self.put_down_at
        other._body = body
        return other

    def _why_impossible(
        self,
        closer: CloseMap,
        start: Pose2,
        goal: Goal,
        margin_m: float | None = None,
    ) -> Outcome | None:
        """Return why no motion of the body reaches the goal; None if one may exist.

        A goal lies inside an obstacle if obstacles enclose all space around it that the
        body could move in, and no beam has measured any of it.
        """
        occupancy, spec = closer.occupancy, closer.spec
        lethal = occupancy >= self.params.lethal_cost
        space = BodySpace(lethal, spec, self.footprint, start, margin_m=margin_m)
        cells, _ = cells_near(spec, (goal.x, goal.y), self._reach_m)
        there = tuple(cells.T)
        if space.reached_from(np.array([space.start]))[there].any():
            return None
        around = space.reached_from(cells)
        is_seen = (occupancy[around] != UNKNOWN).any()
        rim = around[[0, -1]].any() or around[:, [0, -1]].any()
        return Outcome.NO_PATH if is_seen or rim else Outcome.GOAL_BLOCKED

    def plan_on_grid(
        self, start: Pose2, goal: Goal, below_m: float = math.inf
    ) -> Plan | None:
        """Plan with the grid search alone and the full margin; None without a path.

        This is cheap, to look for a better path while one is being driven: one that
        cannot cost less than ``below_m`` may not be found.
        """
        self.hold(goal)
        if self._own is not None or self._refusal(start, goal) is not None:
            return None
        margin = self.params.clearance_margin_m
        grid = self._opened(margin, start)
        xy = goal.x, goal.y
        try:
            route = self.router.route(grid, self.body, start, xy, goal.yaw, below_m)
        except MethodFaultError:
            return None
        if route is None:
            return None
        poses = self._cut_to_fit(grid, start, goal, route)
        return None if poses is None else self._planned(goal, poses, margin, 0)

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
        return path_cost(
            poses,
            self.grid(),
            turn_cost_m_per_rad=self.params.turn_cost_m_per_rad,
            reverse_factor=self.params.reverse_factor,
        )

    def _refusal(self, start: Pose2, goal: Goal) -> Outcome | None:
        if not all(map(math.isfinite, (goal.x, goal.y, goal.yaw or 0.0))):
            return Outcome.GOAL_NOT_FINITE
        if self.grid().cell_of(goal.x, goal.y) is None:
            return Outcome.GOAL_OUTSIDE_MAP
        if self.grid().cell_of(start.x, start.y) is None:
            return Outcome.START_OUTSIDE_MAP
        return None

    def _plan_with(
        self, margin_m: float, start: Pose2, goal: Goal, *, max_expansions: int
    ) -> Plan:
        grid = self._opened(margin_m, start)
        route = self.router.route(grid, self.body, start, (goal.x, goal.y), goal.yaw)
        if route is None:
            end, why_not = self._end_nearby(grid, start, goal)
            if end is None:
                return Plan(why_not)
            route = self.router.route(grid, self.body, start, end, goal.yaw)
            assert route is not None, "the end was chosen among reachable cells"
        fitting = self._cut_to_fit(grid, start, goal, route)
        if self.params.drive == OMNI and margin_m < self.params.clearance_margin_m:
            fitting = self._held(grid, start, goal, fitting)
        if fitting is not None and not self._ends_cramped(grid, fitting):
            return self._planned(goal, fitting, margin_m, 0)
        detour = DetourPlanner(
            grid,
            self.body,
            replace(self.params, max_expansions=max_expansions),
            self.router,
            self._unseen(start),
        ).plan(start, Target(goal.x, goal.y, goal.yaw, self._reach_m), route)
        poses = fitting if detour.poses is None else detour.poses
        if poses is None:
            why = Outcome.SEARCH_LIMIT if detour.exhausted else Outcome.NO_PATH
            return Plan(why, expansions=detour.expansions)
        return self._planned(goal, poses, margin_m, detour.expansions)

    def _held(
        self, grid: PlanningGrid, start: Pose2, goal: Goal, route: Poses | None
    ) -> Poses | None:
        """Return the route driven without turning, if the body fits and it costs less.

        An omnidirectional robot need not turn where there is hardly room for it.
        """
        if route is None:
            return None
        poses = np.column_stack([route[:, :2], np.full(len(route), start.yaw)])
        poses = poses[np.append(True, np.any(np.diff(poses[:, :2], axis=0), axis=1))]
        if goal.yaw is not None:
            x, y, yaw = poses[-1].tolist()
            poses = np.concatenate([poses, turn_in_place(x, y, yaw, goal.yaw)])
        fits = check_path(poses, grid, self.body).first_bad is None
        return poses if fits and self.cost_of(poses) < self.cost_of(route) else route

    def _unseen(self, start: Pose2) -> NDArray[np.uint8]:
        """Return (H, W) 1 for the cells that the body does not enter in reverse."""
        assert self._map is not None, "set_map comes first"
        put_down_at = self.put_down_at or start
        hand_m = self.params.blind_reverse_m
        area = StartArea.of(self.footprint, put_down_at, hand_m)
        return unseen_mask(Layer(self._map.cells, self._map.spec), area)

    def _ends_cramped(self, grid: PlanningGrid, route: Poses) -> bool:
        """Return whether a robot that stops slightly late would be too close."""
        last = clearances(route[-1:], grid, self.body)
        return bool(last[0] < _ROOMY_END * grid.margin_m)

    @property
    def _reach_m(self) -> float:
        """Largest distance from the goal at which a path may end.

        Less than the tolerance, because the robot may stop before the path's end.
        """
        params = self.params
        return max(
            params.goal_tolerance_m - params.path_end_tolerance_m,
            0.5 * params.goal_tolerance_m,
        )

    def _opened(self, margin_m: float, start: Pose2) -> PlanningGrid:
        """Return the grid with the body's cells free and the start open."""
        assert self._map is not None, "set_map comes first"
        grid = self.grid(margin_m)
        grid = without_obstacles_in(grid, self._map.cells, start, self.body)
        cell = grid.cell_of(start.x, start.y)
        assert cell is not None, "the start lies in the map"
        return open_at(grid, cell, self.body)

    def _end_nearby(
        self, grid: PlanningGrid, start: Pose2, goal: Goal
    ) -> tuple[tuple[float, float] | None, Outcome]:
        """Return an end of the path near the goal, or None and the reason."""
        cell = grid.cell_of(start.x, start.y)
        assert cell is not None, "the start lies in the map"
        near, outcome = nearest_reachable(
            grid, cell, (goal.x, goal.y), self._reach_m, self.body
        )
        return (None if near is None else grid.spec.center_of(*near)), outcome

    def _cut_to_fit(
        self, grid: PlanningGrid, start: Pose2, goal: Goal, route: Poses
    ) -> Poses | None:
        """Return the route, shortened slightly if needed, if the body fits along it."""
        if not self.params.turns_in_place and not self._is_steerable(start, route):
            return None
        sweep = turn_in_place(start.x, start.y, start.yaw, float(route[0, 2]))
        check = check_path(np.concatenate([sweep, route]), grid, self.body)
        if check.first_bad is None:
            return self._cut_for_comfort(grid, goal, route)
        kept = route[: max(0, check.first_bad - len(sweep))]
        if goal.yaw is not None or len(kept) < 2:
            return None
        missing = math.dist(kept[-1, :2], (goal.x, goal.y))
        if missing > _CUT_SHARE * self.params.goal_tolerance_m:
            return None
        return self._cut_for_comfort(grid, goal, kept)

    def _is_steerable(self, start: Pose2, route: Poses) -> bool:
        """Return whether an Ackermann drive can follow the route from the start."""
        yaws = np.concatenate([[start.yaw], route[:, 2]])
        turned = np.abs(np.remainder(np.diff(yaws) + np.pi, 2 * np.pi) - np.pi)
        driven = np.concatenate([[0.0], lengths(route)])
        radius = self.params.min_turning_radius_m
        return bool(np.all(turned * radius <= driven + _STEERABLE_M))

    def _cut_for_comfort(self, grid: PlanningGrid, goal: Goal, route: Poses) -> Poses:
        """Shorten the route to an end with more clearance, if that is near enough."""
        away = np.hypot(route[:, 0] - goal.x, route[:, 1] - goal.y)
        near = away <= _CUT_SHARE * self.params.goal_tolerance_m
        first = len(route) - int(np.argmin(near[::-1])) if not near.all() else 1
        tail = route[first:]
        if goal.yaw is not None or not len(tail):
            return route
        roomy = clearances(tail, grid, self.body) >= _ROOMY_END * grid.margin_m
        if not roomy.any():
            return route
        return route[: first + int(np.flatnonzero(roomy)[-1]) + 1]

    def _planned(
        self, goal: Goal, poses: Poses, margin_m: float, expansions: int
    ) -> Plan:
        off = math.dist(poses[-1, :2], (goal.x, goal.y))
        snapped = off > self.params.path_end_tolerance_m
        outcome = Outcome.GOAL_SNAPPED if snapped else Outcome.OK
        return Plan(outcome, poses, self.cost_of(poses), margin_m, expansions)


def _own_plan(params: PlannerParams) -> OwnPlan | None:
    """Return the user's planner; None if the method is a search."""
    method = PLANNERS.load(params.method)
    if method.entry != "plan":
        return None
    return OwnPlan(params, method.make(params), method.name)
