"""Plan where no path was found on the map's own cells: finer cells, or a proof.

The steps: cut out the map in cells of 2.5 cm, prove that no path exists, search through
gaps with a part of the budget, search with all of it only where a path may exist, and
try all motions on a fine grid.
"""

import itertools
import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import (
    UNKNOWN,
    distance_field,
    exact_clearances,
    make_obstacles,
    make_outline,
)
from navette.navigation.planning.body_reach import SWAY_M, BodyReach
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.margin_planner import FIRST_EXPANSIONS, MarginPlanner
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.params import LEAST_EXPANSIONS, PlannerParams
from navette.navigation.planning.path_shape import (
    Poses,
    directions,
    joined,
    turn_in_place,
)
from navette.navigation.planning.plan import Plan
from navette.navigation.planning.planning_grid import BodyShape
from navette.navigation.planning.prepared_map import PreparedMap
from navette.navigation.planning.received_map import NewMap
from navette.navigation.planning.route import GridRouter

# Searches on the map's own cells, and through gaps, get this part of the budget.
_QUICK_SHARE = 4
# Where the body passes within the resolution or not at all, the search gets this part.
_DOUBTFUL_SHARE = 16
# The search along a path by all motions, which is the plan otherwise, gets this part.
_ALONG_SHARE = 16
# The clearance in a passage is not planned below what the controller keeps, which would
# refuse a path with less.
_LEAST_M = 0.025


def quick_expansions(params: PlannerParams) -> int:
    """Return the budget of a search before the proof that no path exists."""
    return max(LEAST_EXPANSIONS, params.max_expansions // _QUICK_SHARE)


def tight_margin_m(params: PlannerParams) -> float:
    """Return the margin where no path has the usual one."""
    return min(params.tight_margin_m, params.clearance_margin_m)


class TightPlanner:
    """Planner for one start and one goal in finer cells of a map."""

    def __init__(self, reach: BodyReach, put_down_at: Pose2 | None) -> None:
        self.params, self.start, self.goal = reach.params, reach.start, reach.goal
        self._reach, self._map = reach, reach.prepared
        self._put_down_at = put_down_at

    def plan(self, plan: Plan) -> Plan:
        """Plan on finer cells.

        Returns ``plan``, with the reason why no path exists if that is proven.
        """
        slack = self._reach.spec.resolution
        margin = self._margin()
        possible = self._reach.possible(margin)
        if not possible.has_goal:
            known = plan.outcome in (Outcome.START_BLOCKED, Outcome.GOAL_BLOCKED)
            why = self._reach.why_impossible() or Outcome.NO_PATH
            return plan if known else replace(plan, outcome=why)
        body = BodyShape.of(self._map.footprint, slack)
        gaps, quick = body.through_gaps(slack), quick_expansions(self.params)
        if not self._reach.certain(margin).has_goal:
            budget = max(LEAST_EXPANSIONS, quick // _DOUBTFUL_SHARE)
            return _proven(self._search(gaps, margin, budget, possible.cells))
        loose, first = body.loose(slack), min(FIRST_EXPANSIONS, quick)
        cells = self._reach.certain(margin).cells
        for shape, budget, within in (
            (gaps, first, None),
            (gaps, quick, cells),
            (loose, first, self._reach.certain(0.0).cells),
        ):
            found = self._search(shape, margin, budget, within)
            if found.outcome.has_path:
                return found
        return self._exhaustive(loose, margin, found)

    def _exhaustive(self, body: BodyShape, margin_m: float, found: Plan) -> Plan:
        """Return a path near one by all motions on a fine grid, or that there is none.

        The search runs only along such a path: a gap that the body cannot pass would
        attract it. Where it fails, the path itself is the plan. It is rough, of
        shorter motions than the search has, and off the cells' centres: it needs only
        the least margin in the end. The first attempt keeps the margin wherever in a
        cell the robot is.
        """
        complete = True
        within_cell_m = math.sqrt(0.5) * self._reach.spec.resolution
        for more_m, yaw in itertools.product(
            (within_cell_m, 0.0), self._yaws(margin_m)
        ):
            driven, poses = self._driven(margin_m + more_m, yaw)
            complete &= driven
            if poses is None:
                continue
            budget = max(LEAST_EXPANSIONS, self.params.max_expansions // _ALONG_SHARE)
            found = self._search(body, margin_m, budget, self._along(poses))
            if found.outcome.has_path:
                return found
            rough = self._rough_plan(poses, min(margin_m, _LEAST_M))
            if rough is not None:
                return replace(rough, expansions=found.expansions)
        if complete:
            return _proven(found)
        cells = self._reach.certain(0.0).cells & self._reach.possible(margin_m).cells
        return self._search(body, margin_m, self.params.max_expansions, cells)

    def _yaws(self, margin_m: float) -> list[float]:
        """Return the first headings of all motions.

        A body that turns in place may also turn to one of those of its passage first.
        """
        here = self.start.yaw
        there = self._reach.certain(margin_m).nearest_yaw(here)
        return [here, there] if self.params.turns_in_place else [here]

    def _driven(self, margin_m: float, yaw: float) -> tuple[bool, Poses | None]:
        """Return whether all motions were tried, and poses (N, 3) to the goal."""
        space = self._reach.certain_space(margin_m, yaw)
        if not self.params.allow_unknown:
            space.close(self._reach.finer.occupancy == UNKNOWN)
        cells = self._reach.ends()
        if not space.reached_from(np.array([space.start]))[tuple(cells.T)].any():
            return True, None
        tolerance = self.params.goal_yaw_tolerance_rad
        drive, radius_m = self.params.drive, self.params.min_turning_radius_m
        until = space.at_yaw(cells, self.goal.yaw, tolerance)
        driven = space.driven(drive, radius_m, until)
        if not driven.stopped:
            return driven.complete, None
        turn = np.array([[self.start.x, self.start.y, self.start.yaw]])
        return True, np.concatenate([turn, driven.last_path()])

    def _along(self, poses: Poses) -> NDArray[np.bool_]:
        """Return the finer cells (H, W) within the body's radius of poses."""
        spec, reach_m = self._reach.spec, self._map.body.circumscribed_m
        marked = np.zeros(spec.shape, np.uint8)
        rows_columns = [spec.cell_of(x, y) for x, y, _ in poses.tolist()]
        marked[tuple(np.array(rows_columns).T)] = 1
        return np.asarray(distance_field(marked, spec.resolution, reach_m) < reach_m)

    def _rough_plan(self, poses: Poses, margin_m: float) -> Plan | None:
        """Return the plan of poses from all motions, if the body fits along them."""
        if self.goal.yaw is not None and self.params.turns_in_place:
            x, y, yaw = poses[-1].tolist()
            poses = joined(poses, turn_in_place(x, y, yaw, self.goal.yaw))
        prepared = self._prepared(None, None)
        grid = prepared.opened(margin_m, self.start)
        if not check_path(poses, grid, prepared.body).fits:
            return None
        if not self._backs_up_into_seen(poses, prepared):
            return None
        return self._planner(prepared).planned(self.goal, poses, margin_m)

    def _backs_up_into_seen(self, poses: Poses, prepared: PreparedMap) -> bool:
        """Return whether the body enters no unseen space in reverse."""
        unseen = prepared.unseen(self._put_down_at or self.start)
        reverse = poses[1:][directions(poses) < 0]
        depth = exact_clearances(
            make_obstacles(unseen, prepared.spec),
            make_outline(self._map.footprint),
            reverse,
            0.0,
        )
        return bool((depth >= -0.5 * prepared.spec.resolution).all())

    def _margin(self) -> float:
        """Return the tight margin, or less in a passage where the robot has less.

        In whole millimetres: spaces of equal margins have parts in common.
        """
        tight = tight_margin_m(self.params)
        here = math.floor((self._reach.start_clearance_m - SWAY_M) * 1000) / 1000
        return min(tight, max(here, _LEAST_M))

    def _search(
        self,
        body: BodyShape,
        margin_m: float,
        max_expansions: int,
        within: NDArray[np.bool_] | None,
    ) -> Plan:
        planner = replace(
            self._planner(self._prepared(body, within)),
            poses=self._reach.possible_space(margin_m).poses,
        )
        return planner.plan(
            margin_m, self.start, self.goal, max_expansions=max_expansions
        )

    def _prepared(
        self, body: BodyShape | None, within: NDArray[np.bool_] | None
    ) -> PreparedMap:
        prepared = PreparedMap(self.params, body, within=within)
        finer = self._reach.finer
        prepared.receive(NewMap(finer.occupancy, finer.spec, self._map.hits))
        return prepared

    def _planner(self, prepared: PreparedMap) -> MarginPlanner:
        router = GridRouter(self.params, centres=True)
        return MarginPlanner(self.params, prepared, router, self._put_down_at)


def _proven(plan: Plan) -> Plan:
    """Return a plan after which no other search could find a path."""
    if plan.outcome is Outcome.SEARCH_LIMIT:
        return replace(plan, outcome=Outcome.NO_PATH)
    return plan
