"""The planner's grid: distance to obstacles, and a cost per cell.

The inflation of the occupancy grid is ignored, because it may be that of another robot:
obstacles are the lethal cells, and distances are computed from them.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Footprint, Pose2
from navette.navigation.grids import (
    GridSpec,
    ObstacleGrid,
    body_points,
    cells_in_footprint,
    distance_field,
    make_obstacles,
    mark_points,
)
from navette.navigation.grids.distance import MAX_RADIUS
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.traversal import (
    LETHAL,
    MAX_PASSABLE_COST,
    Cell,
    EdgeTable,
)

# Share of the full clearance cost that applies at once where the body can no longer
# turn in place: a step keeps paths out of there, a slope alone would not.
_STEP = 0.2
# Distance step of the cost table.
_LEVEL_M = 0.004

NO_HITS = np.empty((0, 2))


@dataclass(frozen=True)
class BodyShape:
    """The robot's body in the base frame.

    Attributes:
        points: (K, 3) x, y, disc radius; see
            :func:`navette.navigation.grids.body_points`.
        inscribed_m, circumscribed_m: radii of the circles about the base.
        closed_m: distance to an obstacle, above the margin, below which a grid search
            does not move the base.
    """

    footprint: Footprint
    points: NDArray[np.float64]
    inscribed_m: float
    circumscribed_m: float
    closed_m: float

    @classmethod
    def of(cls, footprint: Footprint, spacing: float) -> "BodyShape":
        return cls(
            footprint,
            body_points(footprint, spacing),
            footprint.inscribed_radius,
            footprint.circumscribed_radius,
            footprint.inscribed_radius,
        )

    def through_gaps(self, slack_m: float) -> "BodyShape":
        """Return the body as it drives along a gap: half its width keeps it out.

        The base may be nearer to an obstacle ahead or behind, or while it turns.
        """
        half_width = max(abs(y) for _, y in self.footprint.vertices)
        return replace(self, closed_m=half_width - slack_m)

    def loose(self, slack_m: float) -> "BodyShape":
        """Return the body with grid cells that are closed only this much nearer."""
        return replace(self, closed_m=max(0.0, self.inscribed_m - slack_m))


@dataclass(frozen=True)
class PlanningGrid:
    """A map prepared for one body.

    Attributes:
        spec: geometry of the grid in the map frame.
        obstacles: (H, W) uint8, 1 = lethal.
        distance_m: (H, W) float32, metres to the nearest lethal cell, clipped.
        cost: (H, W) uint8 for ``table``; 255 where the base cannot be.
        margin_m: clearance that the body keeps.
        hits: (N, 2) map frame, m: where beams ended; empty = not known.
    """

    spec: GridSpec
    obstacles: NDArray[np.uint8]
    distance_m: NDArray[np.float32]
    cost: NDArray[np.uint8]
    table: EdgeTable
    margin_m: float
    hits: NDArray[np.float64]

    @cached_property
    def exact_obstacles(self) -> ObstacleGrid:
        """The lethal cells with the points in them, for exact clearances."""
        masks = np.zeros(self.spec.shape, np.uint64)
        mark_points(masks, self.spec, self.hits)
        return make_obstacles(self.obstacles, self.spec, masks)

    @property
    def outside_m(self) -> float:
        """Distance to obstacles assumed outside the map."""
        return float(self.distance_m.max())

    def factor(self) -> NDArray[np.float32]:
        """Return (H, W) the cost of a metre in each cell; closed: the highest."""
        cost = np.minimum(self.cost, MAX_PASSABLE_COST).astype(np.float32)
        return 1 + np.float32(self.table.weight / MAX_PASSABLE_COST) * cost

    def factor_at(
        self, rows: NDArray[np.int64], columns: NDArray[np.int64]
    ) -> NDArray[np.float64]:
        """Return (N,) the cost of a metre in these cells; closed: the highest."""
        cost = np.minimum(self.cost[rows, columns], MAX_PASSABLE_COST).astype(
            np.float64
        )
        return 1 + self.table.weight / MAX_PASSABLE_COST * cost

    def cell_of(self, x: float, y: float) -> Cell | None:
        """Return the cell of a point in the map frame; None outside."""
        cell = self.spec.cell_of(x, y)
        return cell if self.spec.contains(*cell) else None

    def distance_at(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(N,) metres to the nearest obstacle from the cells of points (N, 2).

        0 for points outside the map, which a search over poses may leave: no route of
        the grid can begin or end there.
        """
        column, row = np.floor(self.to_cells(points)).astype(np.int64).T
        height, width = self.distance_m.shape
        inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
        distance = np.zeros(len(points))
        distance[inside] = self.distance_m[row[inside], column[inside]]
        return distance

    def to_cells(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Convert points (N, 2) x, y in metres to u, v in cells from the corner."""
        return self.spec.origin.inverse().apply(points) / self.spec.resolution

    def to_metres(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Convert points (N, 2) u, v in cells to x, y in metres in the map frame."""
        return self.spec.origin.apply(points * self.spec.resolution)


def planning_grid(
    occupancy: NDArray[np.int8],
    spec: GridSpec,
    body: BodyShape,
    params: PlannerParams,
    hits: NDArray[np.float64] = NO_HITS,
) -> PlanningGrid:
    """Prepare an occupancy grid (H, W): −1 unknown, 0 free … 100 occupied."""
    if occupancy.shape != spec.shape:
        raise InvalidValueError(
            f"occupancy grid of shape {occupancy.shape}: expected {spec.shape}"
        )
    return _prepared(
        occupancy,
        (occupancy >= params.lethal_cost).astype(np.uint8),
        spec,
        body,
        params,
        hits,
    )


def without_obstacles_in(
    grid: PlanningGrid,
    occupancy: NDArray[np.int8],
    start: Pose2,
    body: BodyShape,
    params: PlannerParams,
) -> PlanningGrid:
    """Remove the lethal cells inside the body at ``start``.

    The robot occupies that space, so such cells are errors: a scan with a wrong pose,
    or the robot's own body.
    """
    inside = cells_in_footprint(body.footprint, start, grid.spec)
    rows, columns = inside[:, 0], inside[:, 1]
    if not grid.obstacles[rows, columns].any():
        return grid
    obstacles = grid.obstacles.copy()
    obstacles[rows, columns] = 0
    return _prepared(occupancy, obstacles, grid.spec, body, params, grid.hits)


def open_at(grid: PlanningGrid, start: Cell, body: BodyShape) -> PlanningGrid:
    """Open a path out of the inflation around ``start``.

    Cells near the start become passable at the highest cost if they are no closer to an
    obstacle than the start.
    """
    if grid.cost[start] != LETHAL:
        return grid
    reach = math.ceil(2 * (body.inscribed_m + grid.margin_m) / grid.spec.resolution)
    rows = slice(max(0, start[0] - reach), start[0] + reach + 1)
    columns = slice(max(0, start[1] - reach), start[1] + reach + 1)
    least = grid.distance_m[start] - 0.5 * grid.spec.resolution
    cost = grid.cost.copy()
    window, distance = cost[rows, columns], grid.distance_m[rows, columns]
    window[(window == LETHAL) & (distance >= least) & (distance > 0)] = (
        MAX_PASSABLE_COST
    )
    cost[start] = MAX_PASSABLE_COST
    return replace(grid, cost=cost)


def _prepared(
    occupancy: NDArray[np.int8],
    obstacles: NDArray[np.uint8],
    spec: GridSpec,
    body: BodyShape,
    params: PlannerParams,
    hits: NDArray[np.float64],
) -> PlanningGrid:
    margin = params.clearance_margin_m
    closed_m = body.closed_m + margin
    free_m = body.circumscribed_m + margin + params.comfort_m
    reach_m = min(free_m + spec.resolution, (MAX_RADIUS - 1) * spec.resolution)
    distance_m = distance_field(obstacles, spec.resolution, reach_m)
    weight = max(
        params.clearance_weight, params.unknown_cost, params.map_cost_weight, 1e-3
    )
    scale = MAX_PASSABLE_COST / weight
    levels = (distance_m * np.float32(1 / _LEVEL_M)).astype(np.int32)
    count = round((free_m + spec.resolution) / _LEVEL_M) + 2
    full = params.clearance_weight * scale
    cost = _clearance_table(count, closed_m, free_m, full).take(levels, mode="clip")
    if params.map_cost_weight > 0:
        own = np.clip(occupancy, 0, 99) * (params.map_cost_weight * scale / 99)
        np.maximum(cost, own.astype(np.uint8), out=cost)
    unknown = occupancy < 0
    if params.allow_unknown:
        floor = np.uint8(min(MAX_PASSABLE_COST, round(params.unknown_cost * scale)))
        np.maximum(cost, floor, out=cost, where=unknown)
    else:
        cost[unknown] = LETHAL
    return PlanningGrid(
        spec, obstacles, distance_m, cost, EdgeTable(weight), margin, hits
    )


def _clearance_table(
    levels: int, closed_m: float, free_m: float, full: float
) -> NDArray[np.uint8]:
    """Return the cost by distance step: closed, then decreasing, then free."""
    distance = (np.arange(levels) + 0.5) * _LEVEL_M
    slope = (free_m - distance) / (free_m - closed_m)
    falling = full * (_STEP + (1 - _STEP) * slope)
    table = np.where(distance < free_m, falling, 0.0)
    table = np.clip(np.rint(table), 0, MAX_PASSABLE_COST).astype(np.uint8)
    table[distance < closed_m] = LETHAL
    return table
