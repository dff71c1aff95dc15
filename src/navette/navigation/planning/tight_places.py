"""Plan where no path was found on the map's own cells: finer cells, or a proof.

The steps: cut out the map in cells of 2.5 cm, prove that no path exists, search through
gaps with a part of the budget, and search with all of it only where a path may exist.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import UNKNOWN, exact_clearances, make_outline
from navette.navigation.planning.body_space import BodySpace
from navette.navigation.planning.close_look import close_map
from navette.navigation.planning.goals import cells_near
from navette.navigation.planning.margin_planner import MarginPlanner, path_end_reach_m
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.own_methods import Goal
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.plan import Plan
from navette.navigation.planning.planning_grid import BodyShape
from navette.navigation.planning.prepared_map import PreparedMap
from navette.navigation.planning.route import GridRouter

# Searches on the map's own cells, and through gaps, get this part of the budget.
_QUICK_SHARE = 4
# In a passage the clearance varies by this, and is not planned below the least, which
# is what the controller keeps: it would refuse a path with less.
_SWAY_M, _LEAST_M = 0.01, 0.025


def quick_expansions(params: PlannerParams) -> int:
    """Return the budget of a search before the proof that no path exists."""
    return params.max_expansions // _QUICK_SHARE


def tight_margin_m(params: PlannerParams) -> float:
    """Return the margin where no path has the usual one."""
    return min(params.tight_margin_m, params.clearance_margin_m)


class TightPlanner:
    """Planner for one start and one goal in finer cells of a map."""

    def __init__(
        self,
        params: PlannerParams,
        prepared: PreparedMap,
        put_down_at: Pose2 | None,
        start: Pose2,
        goal: Goal,
    ) -> None:
        self.params, self.start, self.goal = params, start, goal
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
        found = self._search(body.through_gaps(slack), margin, quick)
        if found.outcome.has_path:
            return found
        # The long search runs only if a path of exact poses at cell centres may exist,
        # and only there: a gap that the body cannot pass would attract it.
        reached, why = self._reached(0.0)
        if why is None:
            budget = self.params.max_expansions
            found = self._search(body.loose(slack), margin, budget, reached)
        if found.outcome is not Outcome.SEARCH_LIMIT:
            return found
        why = self.why_impossible(margin)
        return found if why is None else replace(found, outcome=Outcome.NO_PATH)

    def why_impossible(self, margin_m: float | None = None) -> Outcome | None:
        """Return why no motion of the body reaches the goal; None if one may exist.

        A goal lies inside an obstacle if obstacles enclose all space around it that the
        body could move in, and no beam has measured any of it.
        """
        return self._reached(margin_m)[1]

    def _reached(
        self, margin_m: float | None
    ) -> tuple[NDArray[np.bool_], Outcome | None]:
        """Return (H, W) where the body can be; see :meth:`why_impossible`."""
        occupancy, spec = self._closer.occupancy, self._closer.spec
        lethal = occupancy >= self.params.lethal_cost
        space = BodySpace(
            lethal, spec, self._map.footprint, self.start, margin_m=margin_m
        )
        goal_xy = self.goal.x, self.goal.y
        cells, _ = cells_near(spec, goal_xy, path_end_reach_m(self.params))
        reached = space.reached_from(np.array([space.start]))
        if reached[tuple(cells.T)].any():
            return reached, None
        around = space.reached_from(cells)
        is_seen = (occupancy[around] != UNKNOWN).any()
        rim = around[[0, -1]].any() or around[:, [0, -1]].any()
        return reached, Outcome.NO_PATH if is_seen or rim else Outcome.GOAL_BLOCKED

    def _margin(self) -> float:
        """Return the tight margin, or less in a passage where the robot has less."""
        pose = np.array([[self.start.x, self.start.y, self.start.yaw]])
        outline = make_outline(self._map.footprint)
        obstacles = self._map.grid().exact_obstacles
        tight = tight_margin_m(self.params)
        here = float(exact_clearances(obstacles, outline, pose, tight + _SWAY_M)[0])
        return min(tight, max(here - _SWAY_M, _LEAST_M))

    def _search(
        self,
        body: BodyShape,
        margin_m: float,
        max_expansions: int,
        within: NDArray[np.bool_] | None = None,
    ) -> Plan:
        prepared = PreparedMap(self.params, body, within=within)
        prepared.receive(self._closer.occupancy, self._closer.spec, self._map.hits)
        router = GridRouter(self.params, centres=True)
        planner = MarginPlanner(self.params, prepared, router, self._put_down_at)
        return planner.plan(
            margin_m, self.start, self.goal, max_expansions=max_expansions
        )
