"""Where the body can be between one start and one goal, by clearance."""

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2, angle_difference
from navette.navigation.grids import (
    UNKNOWN,
    GridSpec,
    cells_in_footprint,
    exact_clearances,
    make_outline,
)
from navette.navigation.planning.body_space import HEADING_STEP, BodySpace
from navette.navigation.planning.close_look import CloseMap, close_map
from navette.navigation.planning.goals import cells_near, path_end_reach_m
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.own_methods import Goal
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.prepared_map import PreparedMap

# In a passage the clearance varies by this.
SWAY_M = 0.01
# Spaces with headings between each other's.
_HEADING_PARTS = 8
# A robot that stops because there is no path still moves by this.
_STOPS_M, _STOPS_RAD = 0.3, 0.3


class Reached(NamedTuple):
    """What the body reaches.

    Attributes:
        cells: finer cells (H, W).
        has_goal: whether the goal is among them.
        yaw: the last headings that were tried count from this one (map).
    """

    cells: NDArray[np.bool_]
    has_goal: bool
    yaw: float = 0.0

    def nearest_yaw(self, yaw: float) -> float:
        """Return the nearest of the last headings."""
        return yaw - math.remainder(yaw - self.yaw, HEADING_STEP)


class NoPath(NamedTuple):
    """A search that found no path, and what it depended on.

    Attributes:
        outcome: the reason.
        start, goal: its ends.
        spec: geometry of the finer map.
        closed: (H, W) its obstacles and unknown cells.
    """

    outcome: Outcome
    start: Pose2
    goal: Goal
    spec: GridSpec
    closed: NDArray[np.bool_]

    def still_holds(self, reach: "BodyReach") -> bool:
        """Return whether nothing has opened since, and the robot is still there."""
        moved = math.dist((self.start.x, self.start.y), (reach.start.x, reach.start.y))
        turned = abs(angle_difference(self.start.yaw, reach.start.yaw))
        return (
            self.goal == reach.goal
            and moved < _STOPS_M
            and turned < _STOPS_RAD
            and self.spec == reach.spec
            and not (self.closed & ~reach.closed).any()
        )


class BodyReach:
    """What the body can reach from a start, on finer cells of a map.

    Everything is computed on demand, once.

    Attributes:
        params: parameters of the planner.
        prepared: the map.
        start, goal: ends of the path.
    """

    def __init__(
        self, params: PlannerParams, prepared: PreparedMap, start: Pose2, goal: Goal
    ) -> None:
        self.params, self.prepared = params, prepared
        self.start, self.goal = start, goal
        self._possible: dict[float, Reached] = {}
        self._certain: dict[float, Reached] = {}
        self._spaces: dict[float, BodySpace] = {}

    @cached_property
    def finer(self) -> CloseMap:
        """The map in finer cells."""
        ends = np.array([(self.start.x, self.start.y), (self.goal.x, self.goal.y)])
        return close_map(
            self.prepared.cells,
            self.prepared.spec,
            self.prepared.hits,
            self.params.lethal_cost,
            ends,
            2 * self._radius_m,
        )

    @property
    def spec(self) -> GridSpec:
        """Geometry of the finer cells."""
        return self.finer.spec

    def ends(self, slack_m: float = 0.0) -> NDArray[np.int64]:
        """Return the finer cells (N, 2) with centres where a path may end."""
        goal_xy, reach_m = (self.goal.x, self.goal.y), path_end_reach_m(self.params)
        return cells_near(self.spec, goal_xy, reach_m + slack_m)[0]

    def possible(self, margin_m: float) -> Reached:
        """Return what the body may reach with a margin, or near the start with less."""
        if margin_m not in self._possible:
            space = self.possible_space(margin_m)
            self._possible[margin_m] = self._flood(space, np.array([space.start]))
        return self._possible[margin_m]

    def certain(self, margin_m: float) -> Reached:
        """Return what the body certainly reaches with a margin, by any motions.

        A long body fits through a narrow passage with few headings: those between the
        ones of a space, and the start's, are tried by further spaces, from where the
        body can turn.
        """
        if margin_m not in self._certain:
            self._certain[margin_m] = self._reach_certainly(margin_m)
        return self._certain[margin_m]

    def _reach_certainly(self, margin_m: float) -> Reached:
        reached = Reached(self._at_start(), has_goal=False)
        parts = [part / _HEADING_PARTS * HEADING_STEP for part in range(_HEADING_PARTS)]
        for yaw in (*parts, self.start.yaw):
            space = self.certain_space(margin_m, yaw)
            seeds = np.argwhere(reached.cells & space.has_room())
            further = self._flood(space, seeds)
            reached = Reached(reached.cells | further.cells, further.has_goal, yaw)
            if reached.has_goal:
                break
        return reached

    def _at_start(self) -> NDArray[np.bool_]:
        """Return (H, W) the start's cell, in which every heading is open."""
        cells = np.zeros(self.spec.shape, np.bool_)
        cells[self.spec.cell_of(self.start.x, self.start.y)] = True
        return cells

    def why_impossible(self) -> Outcome | None:
        """Return why no motion of the body reaches the goal; None if one may exist.

        A goal lies inside an obstacle if obstacles enclose all space around it that the
        body could move in, and no beam has measured any of it.
        """
        if self.possible(0.0).has_goal:
            return None
        around = self.possible_space(0.0).reached_from(self.ends())
        is_seen = (self.finer.occupancy[around] != UNKNOWN).any()
        rim = around[[0, -1]].any() or around[:, [0, -1]].any()
        return Outcome.NO_PATH if is_seen or rim else Outcome.GOAL_BLOCKED

    def no_path(self, outcome: Outcome) -> NoPath:
        """Return that no path exists."""
        return NoPath(outcome, self.start, self.goal, self.spec, self.closed)

    @property
    def closed(self) -> NDArray[np.bool_]:
        """The obstacles and unknown cells (H, W)."""
        return np.asarray(self.lethal | (self.finer.occupancy == UNKNOWN))

    def on_map(self, cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return (H, W) the cells of the map with any of these finer ones, (M, N).

        Cells beyond the finer map have no obstacles, and are returned, too.
        """
        return self.finer.on_map(cells, self.prepared.spec.shape)

    def possible_space(self, margin_m: float) -> BodySpace:
        """Return the poses that may have a margin, or near the start less."""
        if margin_m not in self._spaces:
            space = BodySpace.possible(*self._world(), margin_m)
            if self.start_clearance_m < margin_m > 0.0:
                space.open_near_start(self.possible_space(0.0), self._radius_m)
            self._spaces[margin_m] = space
        return self._spaces[margin_m]

    def certain_space(self, margin_m: float, yaw: float = 0.0) -> BodySpace:
        """Return the poses that certainly have a margin, or near the start less.

        Headings count from a yaw (map).
        """
        space = BodySpace.certain(*self._world(), margin_m, yaw=yaw)
        if self.start_clearance_m < margin_m:
            free = BodySpace.certain(*self._world(), yaw=yaw)
            space.open_near_start(free, self._radius_m)
        return space

    @cached_property
    def start_clearance_m(self) -> float:
        """Clearance of the body at the start, up to the usual margin."""
        pose = np.array([[self.start.x, self.start.y, self.start.yaw]])
        outline = make_outline(self.prepared.footprint)
        obstacles = self.prepared.grid().exact_obstacles
        enough = self.params.clearance_margin_m + SWAY_M
        return float(exact_clearances(obstacles, outline, pose, enough)[0])

    @property
    def _radius_m(self) -> float:
        return self.prepared.body.circumscribed_m

    def _flood(self, space: BodySpace, seeds: NDArray[np.int64]) -> Reached:
        cells = space.reached_from(seeds)
        # The path's end may be anywhere in its cell.
        ends = self.ends(math.sqrt(0.5) * self.spec.resolution)
        return Reached(cells, bool(cells[tuple(ends.T)].any()))

    def _world(self) -> tuple[NDArray[np.bool_], GridSpec, Footprint, Pose2]:
        return self.lethal, self.spec, self.prepared.footprint, self.start

    @cached_property
    def lethal(self) -> NDArray[np.bool_]:
        """The obstacles (H, W) except where the body is at the start."""
        lethal = self.finer.occupancy >= self.params.lethal_cost
        inside = cells_in_footprint(self.prepared.footprint, self.start, self.spec)
        lethal[tuple(inside.T)] = False
        return lethal
