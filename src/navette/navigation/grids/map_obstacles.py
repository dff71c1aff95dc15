"""Obstacles of the newest map near the robot that the costmap does not show.

The points of lethal cells change with the map, a few times per second; which of these
cells the costmap shows changes with every costmap.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.msgs.sensor_msgs.msg import PointCloud2
from navette.navigation.grids.hit_points import HitPoints
from navette.navigation.grids.obstacle_points import obstacle_points, points_within
from navette.navigation.grids.spec import UNKNOWN, Cells, GridSpec, grid_frame
from navette.navigation.grids.sub_cells import NO_POINTS, CellMarks, Points
from navette.navigation.grids.unseen import Layer

_HERE = Pose2(0.0, 0.0, 0.0)
# Cells are collected this far beyond the reach: with a map that does not change, again
# only when the robot has driven on.
_AHEAD_M = 1.0


class LethalCells(NamedTuple):
    """Lethal cells of a map, and the points that stand for each; metres, map.

    Attributes:
        centers: (M, 2) of the cells.
        first: (M + 1,) index of the first point of each cell.
        points: (N, 2), cell by cell.
    """

    centers: Points
    first: NDArray[np.int64]
    points: Points


class Region(NamedTuple):
    """Where lethal cells are collected, and what counts as lethal.

    Attributes:
        around: centre.
        reach_m: radius.
        lethal_cost: value from which a cell is an obstacle.
        radius_m: of each point; None: the centres of the cells are the points.
    """

    around: Pose2
    reach_m: float
    lethal_cost: int
    radius_m: float | None

    def contains(self, other: "Region") -> bool:
        """Return whether the cells of another region are some of those of this one."""
        beyond_m = self.around.distance_to(other.around) + other.reach_m - self.reach_m
        return beyond_m <= 0.0 and self[2:] == other[2:]


class MapObstacles:
    """The newest map, where its beams ended, and its lethal cells near the robot."""

    def __init__(self) -> None:
        self._hits = HitPoints()
        self._map: tuple[Cells, GridSpec] | None = None
        self._stamp_ns = 0
        self._near: tuple[Region, LethalCells] | None = None

    @property
    def half_cell_m(self) -> float:
        """Half the edge of a cell; 0 without a map."""
        return 0.0 if self._map is None else self._map[1].resolution / 2

    def receive(self, cells: Cells, spec: GridSpec, stamp_ns: int) -> None:
        """Replace the map, in the map frame."""
        self._map, self._stamp_ns = (cells, spec), stamp_ns
        self._near = None

    def receive_points(self, msg: PointCloud2) -> None:
        """Use the points for the map with the same stamp.

        Raises:
            InvalidValueError: the cloud is invalid.
        """
        self._hits.receive(msg)

    def hidden_from(self, costmap: Layer, region: Region, body_m: float) -> Points:
        """Return the points (N, 2) of lethal cells that are not in known cells.

        In the circle of radius ``body_m`` around the centre of the region, free cells
        of the costmap beside obstacle cells do not count: beams along a surface pass
        through the cells of its end.
        """
        if self._map is None:
            return NO_POINTS
        if self._near is None or not self._near[0].contains(region):
            wider = region._replace(reach_m=region.reach_m + _AHEAD_M)
            self._near = wider, self._lethal_cells(*self._map, wider)
        points: Points = _hidden(
            self._near[1],
            costmap.cells,
            grid_frame(costmap.spec),
            region.lethal_cost,
            (region.around.x, region.around.y, region.reach_m, body_m),
        )
        return points

    def _lethal_cells(
        self, cells: Cells, spec: GridSpec, region: Region
    ) -> LethalCells:
        centers = obstacle_points(
            cells,
            spec,
            _HERE,
            lethal_cost=region.lethal_cost,
            around=region.around,
            reach_m=region.reach_m,
        )
        if region.radius_m is None:
            return LethalCells(centers, np.arange(len(centers) + 1), centers)
        hits = self._hits.at(self._stamp_ns)
        if hits is None:
            hits = NO_POINTS
        # A point is less than an edge away from the centre of its cell.
        reach_m = region.reach_m + spec.resolution
        near = points_within(hits, _HERE, around=region.around, reach_m=reach_m)
        marks = CellMarks.of(spec, near)
        first, points = marks.points_by_cell(spec, centers, region.radius_m)
        return LethalCells(centers, first, points)


@kernel
def _hidden(near: LethalCells, cells: Any, frame: Any, lethal: int, region: Any) -> Any:
    """Return the points of the cells that are hidden from a costmap.

    ``region``: x, y, reach and radius of the body.
    """
    x, y, reach, body = region
    height, width = cells.shape
    points = np.empty_like(near.points)
    count = 0
    for k in range(near.centers.shape[0]):
        cx, cy = near.centers[k, 0], near.centers[k, 1]
        away = (cx - x) ** 2 + (cy - y) ** 2
        if away > reach * reach:
            continue
        dx, dy = cx - frame.x, cy - frame.y
        column = math.floor((frame.cos * dx + frame.sin * dy) / frame.resolution)
        row = math.floor((frame.cos * dy - frame.sin * dx) / frame.resolution)
        inside = 0 <= row < height and 0 <= column < width
        known = inside and cells[row, column] != UNKNOWN
        if known and away <= body * body:
            known = not _is_beside(cells, row, column, lethal)
        if not known:
            for i in range(near.first[k], near.first[k + 1]):
                points[count, 0], points[count, 1] = (
                    near.points[i, 0],
                    near.points[i, 1],
                )
                count += 1
    return points[:count]


@kernel(allocates=False)
def _is_beside(cells: Any, row: int, column: int, lethal: int) -> bool:
    """Return whether a free cell has an obstacle cell beside it."""
    if cells[row, column] >= lethal:
        return False
    height, width = cells.shape
    for i in range(max(0, row - 1), min(height, row + 2)):
        for j in range(max(0, column - 1), min(width, column + 2)):
            if cells[i, j] >= lethal:
                return True
    return False
