"""The newest map, prepared for planning: one grid per margin, each made on demand."""

import copy
import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import (
    NO_DISCS,
    CellWindow,
    GridSpec,
    Layer,
    StartArea,
    unseen_mask,
)
from navette.navigation.planning.moving_cost import with_moving
from navette.navigation.planning.new_map import NewMap
from navette.navigation.planning.params import PlannerParams
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
from navette.navigation.planning.traversal import LETHAL

# Cells that are updated when a map arrives, in 17 ms. A larger change is prepared with
# the next plan, in a worker: 200 m took 70 ms, while the commands of the robot waited.
_MOST_UPDATED = 4_000_000


class PreparedMap:
    """The map, what moves in it, and their grids for one body.

    Attributes:
        footprint: outline of the body.
        hits: (N, 2), map frame, m: where beams ended within lethal cells.

    Args:
        params: parameters of the planner.
        body: instead of that of the parameters.
        within: (H, W) cells of the only map outside of which the base cannot be.
    """

    def __init__(
        self,
        params: PlannerParams,
        body: BodyShape | None = None,
        *,
        within: NDArray[np.bool_] | None = None,
    ) -> None:
        self.footprint = Footprint.from_flat(params.footprint_m)
        self.hits = NO_HITS
        self._params = params
        self._map: PlanningMap | None = None
        self._given_body = self._body = body
        self._within = within
        self._some_cost_fell = True
        self._grids: dict[float, PlanningGrid] = {}
        self._moving = NO_DISCS
        self._moved: dict[float, PlanningGrid] = {}  # grids with what moves

    def copy(self) -> "PreparedMap":
        """Return the same map, which changes independently after :meth:`detach`."""
        other = copy.copy(self)
        other._map = copy.copy(self._map)
        other._grids = self._grids.copy()
        other._moved = self._moved.copy()
        return other

    def detach(self) -> None:
        """Take arrays of its own: copies keep what they have."""
        if self._map is not None:
            self._map = self._map.copy()
        self._grids = {margin: grid.copy() for margin, grid in self._grids.items()}

    @property
    def is_empty(self) -> bool:
        """Whether no map has arrived."""
        return self._map is None

    @property
    def cells(self) -> NDArray[np.int8]:
        """Occupancy (H, W): −1 unknown, 0 free … 100 occupied."""
        return self._present.cells

    @property
    def spec(self) -> GridSpec:
        """Geometry of the cells."""
        return self._present.spec

    @property
    def body(self) -> BodyShape:
        """The body, sampled at the map's resolution."""
        assert self._body is not None, "a map comes first"
        return self._body

    @property
    def _present(self) -> PlanningMap:
        assert self._map is not None, "a map comes first"
        return self._map

    def receive(self, new: NewMap) -> None:
        """Replace the map."""
        self._fit_body_to(new.spec.resolution)
        self.hits = new.hits
        self._moved.clear()
        window = None
        if self._map is None:
            self._map = PlanningMap(new.cells, new.spec)
        else:
            window = self._map.receive(new.cells, new.spec, new.changed)
        if window is None:
            self._grids.clear()
            self._some_cost_fell = True
        else:
            self._update_grids(window)

    def _fit_body_to(self, resolution: float) -> None:
        known = None if self._map is None else self._map.spec.resolution
        if self._given_body is None and resolution != known:
            self._body = BodyShape.of(self.footprint, resolution)

    def _update_grids(self, window: CellWindow) -> None:
        """Update the grid of the usual margin; others are prepared again on demand."""
        margin = self._params.clearance_margin_m
        grid = self._grids.get(margin)
        self._grids.clear()
        if grid is None or math.prod(window.shape) > _MOST_UPDATED:
            self._some_cost_fell = True
            return
        self._grids[margin], fell = update_grid(
            grid, self.cells, window, self._params.lethal_cost, self.hits
        )
        self._some_cost_fell |= fell

    def hold(self, x: float, y: float) -> None:
        """Enlarge the map to hold a point (m, map frame), within ``max_size_m``."""
        if self._map is None or not all(map(math.isfinite, (x, y))):
            return
        if self._map.hold(x, y, self._params.max_size_m):
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

    def grid(self, margin_m: float | None = None) -> PlanningGrid:
        """Return the map prepared for a margin (default: clearance_margin_m)."""
        margin = self._params.clearance_margin_m if margin_m is None else margin_m
        if margin not in self._grids:
            params = replace(self._params, clearance_margin_m=margin)
            self._grids[margin] = planning_grid(
                self.cells, self.spec, self.body, params, self.hits
            )
        if not len(self._moving):
            return self._grids[margin]
        if margin not in self._moved:
            self._moved[margin] = with_moving(
                self._grids[margin],
                self._moving,
                self._params.moving_horizon_s,
                self.body.inscribed_m,
            )
        return self._moved[margin]

    def opened(self, margin_m: float, start: Pose2) -> PlanningGrid:
        """Return the grid with the body's cells free and the start open."""
        grid = self.grid(margin_m)
        grid = without_obstacles_in(grid, self.cells, start, self.body)
        cell = grid.cell_of(start.x, start.y)
        assert cell is not None, "the start lies in the map"
        grid = open_at(grid, cell, self.body)
        if self._within is None:
            return grid
        return replace(grid, cost=np.where(self._within, grid.cost, np.uint8(LETHAL)))

    def unseen(self, put_down_at: Pose2) -> NDArray[np.uint8]:
        """Return (H, W) 1 for the cells that the body does not enter in reverse.

        Space around the pose where the robot was put down counts as seen.
        """
        hand_m = self._params.blind_reverse_m
        area = StartArea.of(self.footprint, put_down_at, hand_m)
        return unseen_mask(Layer(self.cells, self.spec), area)
