"""Detours: paths for the footprint where the grid's route does not fit.

The search with headings finds paths through tight places: in reverse out of a corner,
along a wall, to the nearest pose that fits at a tight goal. Its paths are jagged, so
they are used for the tight part only; before and after it, the path follows the grid's
route wherever the footprint fits.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference, wrap_angles
from navette.navigation.grids import exact_clearances, make_outline
from navette.navigation.planning import lattice, path_shape
from navette.navigation.planning.dijkstra import Guide, guide_to
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.goals import cells_near
from navette.navigation.planning.lattice_kernels import GOOD_ENOUGH_M, HEURISTIC_WEIGHT
from navette.navigation.planning.lattice_motions import Motions
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import Poses, joined, turn_in_place
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid
from navette.navigation.planning.route import GridRouter
from navette.navigation.planning.traversal import STRAIGHT

# A route with fewer poses has no heading of its own; smaller turns are useless.
_LEAST_ROUTE, _ALIGNED_RAD = 3, 0.01
# Places with this much more clearance than the tightest have its heading, too.
_AS_TIGHT_M = 0.01
# Squares of the search where centimetres matter.
_FINE_M = 0.05
# Cost of a metre between the path's end and the exact goal, in metres driven.
_GOAL_PULL = 5.0
_TAILS_TRIED = 8
# A detour leads back to the route this far behind a tight place, if as much is left of
# it; the deviation from its pose there.
_BEHIND_M, _REJOIN_M = 15.0, 0.1
# How much longer than the cheapest the ways are whose cells have their cost to go, in
# metres driven. A search that met other cells is repeated with longer ones.
_BEYOND_M, _BEYOND_GROWTH = 5.0, 4.0


@dataclass(frozen=True)
class Target:
    """The goal in the map frame; any pose within the tolerance is accepted."""

    x: float
    y: float
    yaw: float | None
    tolerance_m: float


@dataclass(frozen=True)
class DetourResult:
    """Poses (N, 3) or None, poses expanded, and whether the budget was exhausted."""

    poses: Poses | None
    expansions: int
    exhausted: bool


class DetourPlanner:
    """Detour planner on one grid for one body.

    ``unseen`` (H, W) is 1 in cells that the body does not enter in reverse.
    """

    def __init__(
        self,
        grid: PlanningGrid,
        body: BodyShape,
        params: PlannerParams,
        router: GridRouter,
        unseen: NDArray[np.uint8],
    ) -> None:
        self.grid, self.body, self.params, self.router = grid, body, params, router
        self._unseen = unseen
        step = min(0.3, max(0.2 * body.circumscribed_m, 2 * grid.spec.resolution))
        # The sharpest bends turn by two heading steps.
        step = max(step, 2 * params.min_turning_radius_m * math.tau / Motions.headings)
        self.motions = Motions(
            step_m=step,
            reach_m=body.circumscribed_m,
            sample_m=min(params.path_spacing_m, step / 2),
            turn_cost_m_per_rad=params.turn_cost_m_per_rad,
            reverse_factor=params.reverse_factor,
            drive=params.drive,
            bins_per_step=_fine_bins(step) if self._steers_precisely else 2,
        )

    def plan(self, start: Pose2, target: Target, route: Poses | None) -> DetourResult:
        """Plan poses for the body; ``route`` is the grid's, which does not fit."""
        if not self.params.turns_in_place:
            return self._plan_steered(start, target, route)
        return self._plan_back(start, route) or self._plan_to(start, target, route)

    def _plan_back(self, start: Pose2, route: Poses | None) -> DetourResult | None:
        """Plan back to a long route, behind its tight places; None if that fails.

        The search would find a way of a hundred metres otherwise, of which the route
        replaces all but the first.
        """
        rejoins = None if route is None else self._far_behind(route)
        if route is None or rejoins is None:
            return None
        x, y, yaw = route[rejoins].tolist()
        there = Target(x, y, yaw, _REJOIN_M)
        found = self._plan_to(start, there, route[: rejoins + 1])
        if found.poses is None:
            return None
        poses = joined(found.poses, route[rejoins:])
        fits = check_path(poses, self.grid, self.body).fits
        return DetourResult(poses, found.expansions, False) if fits else None

    def _far_behind(self, route: Poses) -> int | None:
        """Return a pose of the route far behind the first tight place and fairly wide.

        None: the rest of the route is short, or does not fit.
        """
        bad = check_path(route, self.grid, self.body).first_bad
        if bad is None:
            return None
        along = np.concatenate([[0.0], np.cumsum(path_shape.lengths(route))])
        far = (along >= along[bad] + _BEHIND_M) & (along <= along[-1] - _BEHIND_M)
        wide = np.flatnonzero(far & self._has_room(route))
        if not len(wide):
            return None
        rejoins = int(wide[0])
        fits = check_path(route[rejoins:], self.grid, self.body).fits
        return rejoins if fits else None

    def _plan_to(
        self, start: Pose2, target: Target, route: Poses | None
    ) -> DetourResult:
        """Plan to the target; the route leads there, but does not fit."""
        effort = 0
        for beginning in (self._usable_beginning(route), _poses(start)):
            if not len(beginning):
                continue
            before = self._aligned(beginning, route)
            found = self._search(before, start, target)
            effort += found.expansions
            if len(found.poses):
                break
        else:
            return DetourResult(None, effort, found.exhausted)
        poses = self._with_route_after(found.poses, target)
        poses = self._turned_to_goal(poses, target)
        return DetourResult(joined(before, poses), effort, False)

    @property
    def _steers_precisely(self) -> bool:
        """Whether a drive that cannot turn in place has centimetres on each side."""
        return self.router.centres and not self.params.turns_in_place

    def _plan_steered(
        self, start: Pose2, target: Target, route: Poses | None
    ) -> DetourResult:
        """Plan for a drive that cannot turn in place.

        The grid's route has corners that the steering cannot follow; in tight places
        its heading is one of the search's, after a short bend forward or in reverse.
        """
        before = _poses(start)
        off = self._heading_off(before, route)
        length_m = self.params.min_turning_radius_m * abs(off)
        for signed_m in (length_m, -length_m) if off else ():
            beginning = path_shape.bend(start, off, signed_m)
            if self.grid.cell_of(*beginning[-1, :2].tolist()) is None:
                continue  # the search cannot begin outside of the map
            if check_path(beginning, self.grid, self.body).fits:
                before = beginning
                break
        found = self._search(before, start, target)
        poses = joined(before, found.poses) if len(found.poses) else None
        return DetourResult(poses, found.expansions, found.exhausted)

    def cost(self, poses: Poses) -> float:
        """Return the cost of a path; see :func:`.path_shape.path_cost`."""
        return path_shape.path_cost(
            poses,
            self.grid,
            turn_cost_m_per_rad=self.params.turn_cost_m_per_rad,
            reverse_factor=self.params.reverse_factor,
        )

    def _usable_beginning(self, route: Poses | None) -> Poses:
        """Return the grid's route up to the last pose with room to turn."""
        nothing = np.empty((0, 3))
        if route is None:
            return nothing
        bad = check_path(route, self.grid, self.body).first_bad
        if bad is None or bad == 0:
            return nothing
        roomy = self._has_room(route[:bad])
        left = np.cumsum(path_shape.lengths(route[: bad + 1])[::-1])[::-1]
        usable = np.flatnonzero(roomy & (left >= self.body.circumscribed_m))
        return route[: usable[-1] + 1] if len(usable) else nothing

    def _aligned(self, before: Poses, route: Poses | None) -> Poses:
        """Return the poses with a turn in place to a heading of the tightest place.

        The search has few headings, counted from its first: without that of a narrow
        passage among them, the body may not fit along it. Only where paths are centred
        in tight places, too.
        """
        off = self._heading_off(before, route)
        if off == 0.0:
            return before
        x, y, yaw = before[-1].tolist()
        turn = turn_in_place(x, y, yaw, yaw + off)
        fits = check_path(
            np.concatenate([before[-1:], turn]), self.grid, self.body
        ).fits
        return joined(before, turn) if fits else before

    def _heading_off(self, before: Poses, route: Poses | None) -> float:
        """Return the turn (rad) after which the tightest place's heading is searched.

        0 where that is one of the headings already, or paths are not centred.
        """
        if not self.router.centres or route is None or len(route) < _LEAST_ROUTE:
            return 0.0
        clearance = exact_clearances(
            self.grid.exact_obstacles,
            make_outline(self.body.footprint),
            route,
            self.body.circumscribed_m,
        )
        step = self.motions.heading_step
        tight = route[clearance <= clearance.min() + _AS_TIGHT_M, 2]
        # A median: single poses may still turn into the passage.
        spread = wrap_angles(tight - tight[0])
        passage = float(tight[0] + np.median(spread))
        off = angle_difference(passage, float(before[-1, 2]))
        off -= step * round(off / step)
        return 0.0 if abs(off) < _ALIGNED_RAD else off

    def _has_room(self, poses: Poses) -> "np.ndarray[tuple[int], np.dtype[np.bool_]]":
        """Return at which poses the body can turn in place."""
        distance = self.grid.distance_at(poses[:, :2])
        needed = self.body.circumscribed_m + self.grid.margin_m
        return np.asarray(distance >= needed + self.grid.spec.resolution)

    def _search(
        self, before: Poses, start: Pose2, target: Target
    ) -> lattice.LatticeResult:
        begin = Pose2(*map(float, before[-1])) if len(before) else start
        goal = lattice.LatticeGoal(
            target.x, target.y, target.tolerance_m, yaw=target.yaw, pull=_GOAL_PULL
        )
        beyond_m = _BEYOND_M
        while True:
            world = self._world(self._guide(target, begin, beyond_m))
            found = lattice.search(
                world,
                begin,
                goal,
                self.motions,
                max_expansions=self.params.max_expansions,
            )
            if not world.guide.met:
                return found
            beyond_m *= _BEYOND_GROWTH

    def _world(self, guide: Guide) -> lattice.LatticeWorld:
        grid = self.grid
        return lattice.LatticeWorld(
            distances=grid.distances,
            factors=grid.factors(),
            guide=guide,
            spec=grid.spec,
            body=self.body.points,
            margin_m=grid.margin_m,
            comfort_m=grid.margin_m + max(self.params.comfort_m, 0.05),
            outside_m=grid.outside_m,
            obstacles=grid.exact_obstacles,
            outline=make_outline(self.body.footprint),
            unseen=self._unseen,
        )

    def _guide(self, target: Target, begin: Pose2, beyond_m: float) -> Guide:
        """Return the cost to go of the cells on good ways from ``begin``."""
        xy = target.x, target.y
        cells, away = cells_near(self.grid.spec, xy, target.tolerance_m)
        off = np.maximum(away - GOOD_ENOUGH_M, 0.0)
        # The search multiplies the guide by HEURISTIC_WEIGHT, but not the goal's cost.
        per_metre = STRAIGHT / self.grid.spec.resolution
        units = off * (_GOAL_PULL / HEURISTIC_WEIGHT * per_metre)
        seeds = [
            ((int(row), int(column)), int(unit))
            for (row, column), unit in zip(cells, units, strict=True)
        ]
        return guide_to(
            self.grid.cost,
            seeds,
            table=self.grid.table,
            start=self.grid.spec.cell_of(begin.x, begin.y),
            beyond=round(beyond_m * per_metre),
        )

    def _with_route_after(self, poses: Poses, target: Target) -> Poses:
        """Return these poses, or some of them and then the grid's route if cheaper."""
        best, best_cost = poses, self.cost(poses)
        along = np.concatenate([[0.0], np.cumsum(path_shape.lengths(poses))])
        apart = max(self.body.circumscribed_m / 2, along[-1] / _TAILS_TRIED / 2)
        tried, at = 0, -math.inf
        for i in np.flatnonzero(self._has_room(poses)):
            if along[i] - at < apart or tried >= _TAILS_TRIED:
                continue
            tried, at = tried + 1, along[i]
            whole = self._route_from(poses, int(i), target)
            if whole is not None and self.cost(whole) < best_cost:
                best, best_cost = whole, self.cost(whole)
        return best

    def _turned_to_goal(self, poses: Poses, target: Target) -> Poses:
        """Return the poses with a turn in place to the goal's heading, if it fits.

        The search ends within a tolerance of the heading. Without the turn, the
        controller's error adds to it, and the goal may not count as reached.
        """
        if target.yaw is None:
            return poses
        x, y, yaw = poses[-1].tolist()
        turn = turn_in_place(x, y, yaw, target.yaw)
        fits = check_path(turn, self.grid, self.body).fits
        return joined(poses, turn) if fits else poses

    def _route_from(self, poses: Poses, i: int, target: Target) -> Poses | None:
        here = Pose2(*map(float, poses[i]))
        end = poses[-1]
        route = self.router.route(
            self.grid, self.body, here, (end[0], end[1]), target.yaw
        )
        if route is None or not check_path(route, self.grid, self.body).fits:
            return None
        return joined(poses[: i + 1], route)


def _fine_bins(step_m: float) -> int:
    return max(2, round(step_m / _FINE_M))


def _poses(pose: Pose2) -> Poses:
    """Return the pose as the only one of a path."""
    return np.array([[pose.x, pose.y, pose.yaw]])
