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
    CellWindow,
    DistanceLevels,
    GridSpec,
    ObstacleGrid,
    body_points,
    cells_in_footprint,
    copied,
    level_type,
    make_obstacles,
    sparse_zeros,
)
from navette.navigation.grids.distance_levels import all_parts
from navette.navigation.planning.cell_costs import CellCosts
from navette.navigation.planning.cheap_tiles import TILE, CheapTiles
from navette.navigation.planning.obstacle_cells import update_obstacles
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.traversal import (
    LETHAL,
    MAX_PASSABLE_COST,
    STRAIGHT,
    Cell,
    EdgeTable,
    copy_costs,
    rimmed_costs,
)

# Largest ratio of an 8-connected path's length to the straight line's.
_OCTILE_RATIO = 1.0824

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
        """Return the body for gaps: cells nearer than half its width are closed.

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

    The arrays belong to one planner, which changes them where the map has changed.

    Attributes:
        spec: geometry of the grid in the map frame.
        obstacles: (H, W) uint8, 1 = lethal.
        distances: (H, W) to the nearest lethal cell, clipped.
        cost: (H, W) uint8 for ``table``; 255 where the base cannot be. It has a rim
            (:func:`.traversal.rimmed_costs`).
        costs: how the cells became costs.
        margin_m: clearance that the body keeps.
        hits: (N, 2) map frame, m: where beams ended; empty = not known.
        cheap: where cells cost less than unknown ones, if those cost more at all.
    """

    spec: GridSpec
    obstacles: NDArray[np.uint8]
    distances: DistanceLevels
    cost: NDArray[np.uint8]
    costs: CellCosts
    margin_m: float
    hits: NDArray[np.float64]
    cheap: CheapTiles | None = None

    def copy(self) -> "PlanningGrid":
        """Return a grid with arrays of its own."""
        return replace(
            self,
            obstacles=copied(self.obstacles),
            distances=self.distances._replace(level=copied(self.distances.level)),
            cost=copy_costs(self.cost),
            cheap=None if self.cheap is None else self.cheap.copy(),
        )

    def least_cost_m(self, start: Cell, goal: Cell) -> float:
        """Return a lower bound on the cost between two cells, in free metres."""
        apart = math.dist(start, goal)
        if self.cheap is None:
            return apart * self.spec.resolution
        away = self.cheap.distances()
        cells = (away[start[0] // TILE, start[1] // TILE] + away[
            goal[0] // TILE, goal[1] // TILE]) / STRAIGHT / _OCTILE_RATIO  # fmt: skip
        excess = self.cheap.excess(self.table) / 10_000
        return (apart + excess * min(apart, float(cells))) * self.spec.resolution

    @cached_property
    def exact_obstacles(self) -> ObstacleGrid:
        """The lethal cells with the points in them, for exact clearances."""
        return make_obstacles(self.obstacles, self.spec, self.hits)

    @property
    def outside_m(self) -> float:
        """Distance to obstacles assumed outside the map."""
        return self.costs.reach_m

    @property
    def table(self) -> EdgeTable:
        """Cost of entering a cell by its cost."""
        return self.costs.table

    def factors(self) -> NDArray[np.float32]:
        """Return (256,) the cost of a metre by the cell's cost; closed: the highest."""
        cost = np.minimum(np.arange(256), MAX_PASSABLE_COST).astype(np.float32)
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
        level, metres = self.distances
        height, width = level.shape
        inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
        distance = np.zeros(len(points))
        distance[inside] = metres[level[row[inside], column[inside]]]
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
    costs = CellCosts.of(params, body.closed_m, body.circumscribed_m, spec.resolution)
    # Outside the known part all cells are alike: unknown, and far from obstacles.
    known = CellWindow.of_known(occupancy)
    obstacles = sparse_zeros(spec.shape, np.uint8)
    lethal = update_obstacles(obstacles, occupancy, known, params.lethal_cost)
    level = sparse_zeros(spec.shape, level_type(costs.metres))
    cost = rimmed_costs(spec.shape, int(costs.far_unknown))
    near, _ = costs.measure(obstacles, level, lethal)
    costs.fill(occupancy, level, cost, known.union(near), all_parts(spec.shape))
    has_floor = 0 < costs.unknown < LETHAL
    return PlanningGrid(
        spec,
        obstacles,
        DistanceLevels(level, costs.metres),
        cost,
        costs,
        params.clearance_margin_m,
        hits,
        CheapTiles(cost, int(costs.unknown), known) if has_floor else None,
    )


def update_grid(
    grid: PlanningGrid,
    occupancy: NDArray[np.int8],
    window: CellWindow,
    lethal_cost: int,
    hits: NDArray[np.float64],
) -> tuple[PlanningGrid, bool]:
    """Change a grid where its map has changed.

    Args:
        grid: its arrays are changed in place.
        occupancy: (H, W) the map as it is now.
        window: the cells that may have changed.
        lethal_cost: occupancy from which a cell is an obstacle.
        hits: as of :class:`PlanningGrid`.

    Returns:
        The grid as it is now, and whether any cost fell.
    """
    level = grid.distances.level
    moved = update_obstacles(grid.obstacles, occupancy, window, lethal_cost)
    near, parts = grid.costs.measure(grid.obstacles, level, moved)
    window = window.union(near)
    fell = grid.costs.fill(occupancy, level, grid.cost, window, parts)
    if grid.cheap is not None:
        grid.cheap.update(grid.cost, window)
    return replace(grid, hits=hits), fell


def without_obstacles_in(
    grid: PlanningGrid, occupancy: NDArray[np.int8], start: Pose2, body: BodyShape
) -> PlanningGrid:
    """Remove the lethal cells inside the body at ``start``.

    The robot occupies that space, so such cells are errors: a scan with a wrong pose,
    or the robot's own body.
    """
    inside = cells_in_footprint(body.footprint, start, grid.spec)
    rows, columns = inside[:, 0], inside[:, 1]
    if not grid.obstacles[rows, columns].any():
        return grid
    other = grid.copy()
    other.obstacles[rows, columns] = 0
    level = other.distances.level
    changed, parts = other.costs.measure(other.obstacles, level, inside)
    other.costs.fill(occupancy, level, other.cost, changed, parts)
    if other.cheap is not None:
        other.cheap.update(other.cost, changed)
    return other


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
    level, metres = grid.distances
    least = metres[level[start]] - 0.5 * grid.spec.resolution
    cost = copy_costs(grid.cost)
    window, distance = cost[rows, columns], metres[level[rows, columns]]
    window[(window == LETHAL) & (distance >= least) & (distance > 0)] = (
        MAX_PASSABLE_COST
    )
    cost[start] = MAX_PASSABLE_COST
    return replace(grid, cost=cost)
