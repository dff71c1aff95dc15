"""Plan where no path was found on the map's own cells: finer cells, or a proof.

The steps: cut out the map in cells of 2.5 cm, prove that no path exists, search through
gaps with a part of the budget, and try all motions on a fine grid. If these reach the
goal, search beside their path for one of longer motions. If they are too many, search
with all of the budget.
"""

import math
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import (
    UNKNOWN,
    distance_field,
    exact_clearances,
    make_outline,
)
from navette.navigation.planning.body_space import BodySpace
from navette.navigation.planning.close_look import close_map
from navette.navigation.planning.drive_path import DriveMoves
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.goals import cells_near
from navette.navigation.planning.margin_planner import MarginPlanner, path_end_reach_m
from navette.navigation.planning.new_map import NewMap
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.own_methods import Goal
from navette.navigation.planning.params import LEAST_EXPANSIONS, PlannerParams
from navette.navigation.planning.path_shape import (
    Poses,
    joined,
    turn_in_place,
)
from navette.navigation.planning.plan import Plan
from navette.navigation.planning.planning_grid import BodyShape
from navette.navigation.planning.prepared_map import PreparedMap
from navette.navigation.planning.route import GridRouter

# Searches on the map's own cells, and beside a path, get this part of the budget,
# those through gaps, after which all motions decide soon, this one.
_QUICK_SHARE, _GAPS_SHARE = 4, 8
# In a passage the clearance varies by this, and is not planned below the least, which
# is what the controller keeps: it would refuse a path with less.
_SWAY_M, _LEAST_M = 0.01, 0.025
_SLACK_M = 1e-3  # a body at rest is not closer than itself
# A search beside a path leaves it by as much. Less, and motions do not fit; more, and
# other gaps attract the search.
_BESIDE_M = 0.2


def quick_expansions(params: PlannerParams, share: int = _QUICK_SHARE) -> int:
    """Return the budget of a search before the proof that no path exists."""
    return max(LEAST_EXPANSIONS, params.max_expansions // share)


def tight_margin_m(params: PlannerParams, more_m: float = 0.0) -> float:
    """Return the margin where no path has the usual one."""
    return min(params.tight_margin_m + more_m, params.clearance_margin_m)


class TightPlanner:
    """Planner for one start and one goal in finer cells of a map."""

    def __init__(
        self,
        params: PlannerParams,
        prepared: PreparedMap,
        put_down_at: Pose2 | None,
        start: Pose2,
        goal: Goal,
        *,
        more_margin_m: float = 0.0,
    ) -> None:
        self.params, self.start, self.goal = params, start, goal
        self._tight_m = tight_margin_m(params, more_margin_m)
        self._least_m = _LEAST_M + more_margin_m
        self._map, self._put_down_at = prepared, put_down_at
        ends = np.array([(start.x, start.y), (goal.x, goal.y)])
        self._closer = close_map(
            prepared.cells,
            prepared.spec,
            prepared.hits,
            params.lethal_cost,
            ends,
            2 * prepared.body.circumscribed_m,
        )

    def plan(self, plan: Plan) -> Plan:
        """Plan on finer cells.

        Returns ``plan``, with the reason why no path exists if that is proven.
        """
        why = self.why_impossible()
        if why is not None:
            known = plan.outcome in (Outcome.START_BLOCKED, Outcome.GOAL_BLOCKED)
            return plan if known else replace(plan, outcome=why)
        slack = self._closer.spec.resolution
        margin = self._margin()
        body = BodyShape.of(self._map.footprint, slack)
        quick = quick_expansions(self.params)
        gaps = quick_expansions(self.params, _GAPS_SHARE)
        found = self._search(body.through_gaps(slack), margin, gaps)
        if found.outcome.has_path:
            return found
        rough = replace(self._exhaustive(margin), expansions=found.expansions)
        if rough.outcome is Outcome.NO_PATH:  # the search may know more of why
            return rough if found.outcome is Outcome.SEARCH_LIMIT else found
        if rough.outcome.has_path:
            budget, within = quick, self._beside(rough.poses)
        else:
            budget, within = self.params.max_expansions, self._reached(0.0)[0]
        found = self._search(body.loose(slack), margin, budget, within)
        if found.outcome.has_path:
            return found
        # A complete search proves nothing but that no motion leaves the start.
        unproven = found.outcome in (Outcome.NO_PATH, Outcome.SEARCH_LIMIT)
        return rough if rough.outcome.has_path or unproven else found

    def why_impossible(self) -> Outcome | None:
        """Return why no motion of the body reaches the goal; None if one may exist.

        A goal lies inside an obstacle if obstacles enclose all space around it that the
        body could move in, and no beam has measured any of it.
        """
        return self._reached(None)[1]

    def _beside(self, poses: Poses) -> NDArray[np.bool_]:
        """Return the cells (H, W) of the finer map near poses (N, 3)."""
        spec = self._closer.spec
        on_path = np.zeros(spec.shape, np.uint8)
        for x, y, _ in poses.tolist():
            on_path[spec.cell_of(x, y)] = 1
        return distance_field(on_path, spec.resolution, 2 * _BESIDE_M) < _BESIDE_M

    def _exhaustive(self, margin_m: float) -> Plan:
        """Return a path by all motions on a fine grid, or that there is none.

        These paths are rough, of shorter motions than the search has. The first keeps
        the margin wherever in a cell the robot is, the second, if the first is not
        found soon, at its exact poses. ``search_limit``: the motions are too many.
        """
        within_cell_m = math.sqrt(0.5) * self._closer.spec.resolution
        reach_m = self._map.body.circumscribed_m
        # Where the robot stands it may have less, and keeps that.
        near_m = min(margin_m, self._clearance_here_m - _SLACK_M)
        near = self._space(near_m - within_cell_m)
        obstacles = self._finer.grid().exact_obstacles
        sure, exact = self._space(margin_m + within_cell_m), self._space(margin_m)
        driven_m = self._moves.longest_m(self._closer.spec.resolution, reach_m)
        proven = self._space(margin_m + within_cell_m + driven_m)
        fit = proven.fit(sure, obstacles, margin_m, near_m, reach_m)
        seen = self._seen_space(within_cell_m)
        cells, outcome = self._ends(), Outcome.NO_PATH
        for space, thorough in ((sure, False), (exact, True)):
            space.open_near_start(near, reach_m)
            if not self.params.allow_unknown:
                space.close(self._closer.occupancy == UNKNOWN)
            if not space.reached_from(np.array([space.start]))[tuple(cells.T)].any():
                continue
            path = space.drive_to(
                cells,
                self._moves,
                seen,
                fit,
                self.goal.yaw,
                self.params.goal_yaw_tolerance_rad,
                thorough=thorough,
            )
            if path.poses is not None:
                return self._rough_plan(path.poses, margin_m)
            outcome = Outcome.NO_PATH if path.is_proof else Outcome.SEARCH_LIMIT
        return Plan(outcome)

    @property
    def _moves(self) -> DriveMoves:
        return DriveMoves(self.params.drive, self.params.min_turning_radius_m)

    def _rough_plan(self, poses: Poses, margin_m: float) -> Plan:
        """Return the plan of poses from all motions.

        They end within half a heading of the goal's; if the body fits, it turns there.
        """
        if self.goal.yaw is not None and self.params.turns_in_place:
            x, y, yaw = poses[-1].tolist()
            turn = turn_in_place(x, y, yaw, self.goal.yaw)
            grid = self._finer.opened(margin_m, self.start)
            if check_path(turn, grid, self._finer.body).fits:
                poses = joined(poses, turn)
        return self._planner(self._finer).planned(self.goal, poses, margin_m)

    def _seen_space(self, margin_m: float) -> BodySpace:
        """Return where the body covers no unseen space, which it does not back into."""
        spec = self._closer.spec
        unseen = self._finer.unseen(self._put_down_at or self.start)
        return BodySpace(
            unseen.astype(np.bool_),
            spec,
            self._map.footprint,
            self.start,
            margin_m=margin_m - 0.5 * spec.resolution,
        )

    def _ends(self) -> NDArray[np.int64]:
        """Return the cells (N, 2) at which a path may end."""
        goal_xy, reach_m = (self.goal.x, self.goal.y), path_end_reach_m(self.params)
        return cells_near(self._closer.spec, goal_xy, reach_m)[0]

    def _space(self, margin_m: float | None) -> BodySpace:
        occupancy, spec = self._closer.occupancy, self._closer.spec
        lethal, body = occupancy >= self.params.lethal_cost, self._map.footprint
        return BodySpace(lethal, spec, body, self.start, margin_m=margin_m)

    def _reached(
        self, margin_m: float | None
    ) -> tuple[NDArray[np.bool_], Outcome | None]:
        """Return (H, W) where the body can be; see :meth:`why_impossible`."""
        occupancy, space = self._closer.occupancy, self._space(margin_m)
        cells = self._ends()
        reached = space.reached_from(np.array([space.start]))
        if reached[tuple(cells.T)].any():
            return reached, None
        around = space.reached_from(cells)
        is_seen = (occupancy[around] != UNKNOWN).any()
        rim = around[[0, -1]].any() or around[:, [0, -1]].any()
        return reached, Outcome.NO_PATH if is_seen or rim else Outcome.GOAL_BLOCKED

    @cached_property
    def _clearance_here_m(self) -> float:
        """Clearance at the start, at most what a path may need."""
        pose = np.array([[self.start.x, self.start.y, self.start.yaw]])
        outline = make_outline(self._map.footprint)
        obstacles = self._map.grid().exact_obstacles
        most = self._tight_m + _SWAY_M
        return float(exact_clearances(obstacles, outline, pose, most)[0])

    def _margin(self) -> float:
        """Return the tight margin, or less in a passage where the robot has less."""
        return min(self._tight_m, max(self._clearance_here_m - _SWAY_M, self._least_m))

    def _search(
        self,
        body: BodyShape,
        margin_m: float,
        max_expansions: int,
        within: NDArray[np.bool_] | None = None,
    ) -> Plan:
        planner = self._planner(self._prepared(body, within))
        return planner.plan(
            margin_m, self.start, self.goal, max_expansions=max_expansions
        )

    @cached_property
    def _finer(self) -> PreparedMap:
        """The map in finer cells, for the body as it is."""
        return self._prepared(None, None)

    def _prepared(
        self, body: BodyShape | None, within: NDArray[np.bool_] | None
    ) -> PreparedMap:
        prepared = PreparedMap(self.params, body, within=within)
        prepared.receive(NewMap(*self._closer, self._map.hits))
        return prepared

    def _planner(self, prepared: PreparedMap) -> MarginPlanner:
        router = GridRouter(self.params, centres=True)
        return MarginPlanner(self.params, prepared, router, self._put_down_at)
