"""Cost of each cell from its distance to obstacles and its occupancy."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import CellWindow, level_metres
from navette.navigation.grids.distance_levels import (
    MAX_LEVEL_RADIUS,
    PART,
    Parts,
    parts_near,
    radius_of,
    update_levels,
)
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.traversal import (
    LETHAL,
    MAX_PASSABLE_COST,
    EdgeTable,
)

# Share of the full clearance cost that applies at once where the body can no longer
# turn in place: a step keeps paths out of there, a slope alone would not.
_STEP_SHARE = 0.2
_STRIP = 512  # rows whose distances are computed at once
# Distance step of the costs.
_STEP_M = 0.004


@dataclass(frozen=True, eq=False)
class CellCosts:
    """How the cells of a map become costs for one body and one margin.

    Attributes:
        reach_m: distance to obstacles from which more does not matter.
        metres: distance by level; see :class:`navette.navigation.grids.DistanceLevels`.
        by_level: cost by that level.
        own_scale: cost by occupancy.
        unknown: least cost of an unknown cell; LETHAL where paths do not cross them.
        table: the edges that belong to the costs.
    """

    reach_m: float
    metres: NDArray[np.float32]
    by_level: NDArray[np.uint8]
    own_scale: float
    unknown: np.uint8
    table: EdgeTable

    @classmethod
    def of(
        cls,
        params: PlannerParams,
        closed_m: float,
        circumscribed_m: float,
        resolution: float,
    ) -> "CellCosts":
        """Return the costs for a body.

        Args:
            params: weights and margins.
            closed_m: distance to an obstacle, above the margin, below which a grid
                search does not move the base.
            circumscribed_m: radius of the circle of a turn in place.
            resolution: edge of a cell, m.
        """
        closed_m += params.clearance_margin_m
        free_m = circumscribed_m + params.clearance_margin_m + params.comfort_m
        weight = max(
            params.clearance_weight, params.unknown_cost, params.map_cost_weight, 1e-3
        )
        scale = MAX_PASSABLE_COST / weight
        count = round((free_m + resolution) / _STEP_M) + 2
        full = params.clearance_weight * scale
        floor = min(MAX_PASSABLE_COST, round(params.unknown_cost * scale))
        reach_m = min(free_m + resolution, MAX_LEVEL_RADIUS * resolution)
        metres = level_metres(resolution, reach_m)
        steps = (metres * np.float32(1 / _STEP_M)).astype(np.int32)
        by_step = _clearance_table(count, closed_m, free_m, full)
        return cls(
            reach_m,
            metres,
            by_step[np.minimum(steps, count - 1)],
            params.map_cost_weight * scale / 99,
            np.uint8(floor if params.allow_unknown else LETHAL),
            EdgeTable(weight),
        )

    @property
    def far_unknown(self) -> np.uint8:
        """Cost of an unknown cell that no obstacle is near to."""
        return max(self.by_level[0], self.unknown)

    def fill(
        self,
        occupancy: NDArray[np.int8],
        level: NDArray[Any],
        cost: NDArray[np.uint8],
        window: CellWindow,
        parts: Parts,
    ) -> bool:
        """Fill in the costs of a window; return whether any cost fell.

        Args:
            occupancy: (H, W).
            level: (H, W) of the distances.
            cost: (H, W), changed in place.
            window: the cells whose occupancy or distance may have changed.
            parts: where a distance may have changed.
        """
        return bool(
            _fill(
                occupancy,
                level,
                cost,
                window,
                parts,
                self.by_level,
                self.own_scale,
                self.unknown,
            )
        )

    def measure(
        self,
        obstacles: NDArray[np.uint8],
        level: NDArray[Any],
        cells: NDArray[np.int64],
    ) -> tuple[CellWindow, Parts]:
        """Fill in the levels (H, W) where obstacles changed in cells (N, 2).

        Returns a window, and where in it distances may have changed.
        """
        reach = radius_of(self.metres)
        parts = parts_near(cells, reach, obstacles.shape)
        near = CellWindow.of_cells(cells).grown(reach, obstacles.shape)
        # In strips: their work arrays are small.
        for first in range(near.first_row, near.last_row, _STRIP):
            last = min(first + _STRIP, near.last_row)
            strip = near._replace(first_row=first, last_row=last)
            update_levels(level, obstacles, self.metres, strip, parts)
        return near, parts


@kernel(allocates=False)
def _fill(
    occupancy: Any,
    level: Any,
    cost: Any,
    window: Any,
    parts: Any,
    by_level: Any,
    own_scale: float,
    unknown: Any,
) -> bool:
    fell = False
    for row in range(window.first_row, window.last_row):
        first, end = window.first_column, window.last_column
        known, line = occupancy[row, first:end], cost[row, first:end]
        every = own_scale > 0.0 or _is_stale(known, line, unknown)
        while first < end:
            stop = min((first // PART + 1) * PART, end)
            if every or parts[row, first // PART]:
                fell |= _fill_part(
                    occupancy[row, first:stop],
                    level[row, first:stop],
                    cost[row, first:stop],
                    by_level,
                    own_scale,
                    unknown,
                )
            first = stop
    return fell


@kernel(allocates=False)
def _is_stale(known: Any, line: Any, unknown: Any) -> bool:
    """Whether cells may have become known or unknown since their costs were filled in.

    This is vectorised; what is always filled in takes ten times longer.
    """
    stale = False
    for k in range(known.size):
        stale |= (line[k] < unknown) if known[k] < 0 else (line[k] == unknown)
    return stale


@kernel(allocates=False)
def _fill_part(
    known: Any, near: Any, line: Any, by_level: Any, own_scale: float, unknown: Any
) -> bool:
    fell = False
    for k in range(line.size):
        new = by_level[near[k]]
        if own_scale > 0.0:
            own = np.uint8(min(max(known[k], 0), 99) * own_scale)
            new = max(new, own)
        if known[k] < 0:
            new = max(new, unknown)
        fell |= new < line[k]
        line[k] = new
    return fell


def _clearance_table(
    steps: int, closed_m: float, free_m: float, full: float
) -> NDArray[np.uint8]:
    """Return the cost by distance step: closed, then decreasing, then free."""
    distance = (np.arange(steps) + 0.5) * _STEP_M
    slope = (free_m - distance) / (free_m - closed_m)
    falling = full * (_STEP_SHARE + (1 - _STEP_SHARE) * slope)
    table = np.where(distance < free_m, falling, 0.0)
    table = np.clip(np.rint(table), 0, MAX_PASSABLE_COST).astype(np.uint8)
    table[distance < closed_m] = LETHAL
    return table
