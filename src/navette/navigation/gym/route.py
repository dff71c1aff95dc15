"""Shortest paths to a goal in the true world, as a field of distances."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, distance_field
from navette.navigation.planning.dijkstra import UNREACHED, cost_to_go
from navette.navigation.planning.traversal import DIAGONAL, LETHAL, STRAIGHT, EdgeTable

_CELL_M = 0.05
_LARGEST = 1000  # cells along an edge; larger worlds have larger cells
_RIM_M = 2.0
_NO_OBSTACLE_M = 10.0  # half edge of the grid of an empty world

Point = tuple[float, float]


class FreeSpace:
    """Distance of each place to the nearest obstacle, from obstacles' outlines.

    Args:
        outlines: convex polygons (N, 2), m.
        include: points that the grid covers, beside the obstacles.
        actors: outlines of actors when an episode begins.

    Attributes:
        spec: the grid.
        occupied: (H, W) uint8, 255 = obstacle.
        room_m: (H, W) distance to the nearest obstacle, at most 2 m.
        start_room_m: the same with the actors.
    """

    def __init__(
        self,
        outlines: Sequence[NDArray[np.float64]],
        include: Sequence[Point],
        actors: Sequence[NDArray[np.float64]] = (),
    ) -> None:
        corners = np.concatenate([np.array(include).reshape(-1, 2), *outlines])
        rim = _RIM_M if outlines else _NO_OBSTACLE_M
        low, high = corners.min(axis=0) - rim, corners.max(axis=0) + rim
        cell = max(_CELL_M, float((high - low).max()) / _LARGEST)
        width, height = np.ceil((high - low) / cell).astype(int).tolist()
        self.spec = GridSpec(cell, width, height, Pose2(low[0], low[1], 0.0))
        self.occupied = self._cells(outlines)
        self.room_m = distance_field(self.occupied, cell, _RIM_M)
        together = self.occupied | self._cells(actors)
        self.start_room_m = distance_field(together, cell, _RIM_M)

    def _cells(self, outlines: Sequence[NDArray[np.float64]]) -> NDArray[np.uint8]:
        """Return the cells (H, W) within convex outlines, as 255."""
        image = Image.new("L", (self.spec.width, self.spec.height))
        draw = ImageDraw.Draw(image)
        for outline in outlines:
            pixels = (outline - self.spec.origin[:2]) / self.spec.resolution - 0.5
            draw.polygon([*map(tuple, pixels.tolist())], fill=LETHAL, outline=LETHAL)
        return np.array(image)


class Route:
    """Length of the shortest path to a goal for a disc, from every place.

    Args:
        space: the obstacles.
        goal: (x, y), m.
        radius_m: of the disc.
    """

    def __init__(self, space: FreeSpace, goal: Point, radius_m: float) -> None:
        self.spec, self.goal = space.spec, goal
        if not self.spec.contains(*self.spec.cell_of(*goal)):
            x, y, edge = *self.spec.origin[:2], self.spec.resolution
            raise InvalidValueError(
                f"({goal[0]:g}, {goal[1]:g}): outside the world, which ends at x "
                f"{x:.1f} and {x + edge * self.spec.width:.1f}, y {y:.1f} and "
                f"{y + edge * self.spec.height:.1f}"
            )
        closed = np.where(space.room_m < radius_m, LETHAL, 0).astype(np.uint8)
        seed = (self.spec.cell_of(*goal), 0)
        self._field = cost_to_go(closed, [seed], table=EdgeTable())
        self._m = self.spec.resolution / STRAIGHT

    @property
    def length_m(self) -> NDArray[np.float64]:
        """(H, W) length from each cell, inf without a path."""
        return np.where(self._field < UNREACHED, self._field * self._m, np.inf)

    def distance(self, at: Point) -> float:
        """Return the length of the shortest path from a place; inf without one.

        Continuous in the place: the least sum of a cell's length and the distance to
        it, over the cells around.
        """
        row, column = self._nearest(at)
        best: float = _distance(
            self._field,
            row,
            column,
            self._m,
            (at[0] - self.spec.origin.x) / self.spec.resolution - 0.5,
            (at[1] - self.spec.origin.y) / self.spec.resolution - 0.5,
            self.spec.resolution,
        )
        return best

    def ahead(self, at: Point, lookahead_m: float) -> Point:
        """Return the point of the shortest path that far from a place, or the goal."""
        row, column = self._nearest(at)
        end = _descend(self._field, row, column, int(lookahead_m / self._m))
        if not 0 < self._field[end] < UNREACHED:
            return self.goal
        x, y = self.spec.centers_of(np.array([end]))[0].tolist()
        return (x, y)

    def _nearest(self, at: Point) -> tuple[int, int]:
        """Return the cell of a place, or the nearest one of the grid."""
        row, column = self.spec.cell_of(*at)
        return (
            min(max(row, 0), self.spec.height - 1),
            min(max(column, 0), self.spec.width - 1),
        )


_AROUND = 3  # cells around a place that may be closed while the place is free


@kernel
def _distance(
    field: Any, row: int, column: int, unit_m: float, x: float, y: float, cell_m: float
) -> float:
    best = np.inf
    for r in range(max(0, row - _AROUND), min(field.shape[0], row + _AROUND + 1)):
        for c in range(
            max(0, column - _AROUND), min(field.shape[1], column + _AROUND + 1)
        ):
            if field[r, c] < UNREACHED:
                gap = cell_m * np.hypot(c - x, r - y)
                best = min(best, field[r, c] * unit_m + gap)
    return best


@kernel
def _descend(field: Any, row: int, column: int, units: int) -> tuple[int, int]:
    """Follow the shortest path down until the field fell by ``units``, or to its end.

    From a closed cell the path begins at the best neighbour.
    """
    r, c, until = row, column, -1
    while True:
        best, best_r, best_c = UNREACHED, r, c
        for dr in range(-1, 2):
            for dc in range(-1, 2):
                n, m = r + dr, c + dc
                if not (0 <= n < field.shape[0] and 0 <= m < field.shape[1]):
                    continue
                length = field[n, m] + (DIAGONAL if dr and dc else STRAIGHT)
                if field[n, m] < field[r, c] and length < best:
                    best, best_r, best_c = length, n, m
        if until < 0 and field[r, c] < UNREACHED:
            until = max(0, field[r, c] - units)
        if best == UNREACHED or field[r, c] <= until:
            return r, c
        r, c = best_r, best_c
