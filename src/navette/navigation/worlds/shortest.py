"""Length of the shortest path of a disc through a world."""

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, distance_field
from navette.navigation.planning.astar import AStar
from navette.navigation.planning.traversal import LETHAL, STRAIGHT

CELL_M = 0.05

Point = tuple[float, float]


def grid_between(low: Point, high: Point) -> GridSpec:
    """Return the grid of :data:`CELL_M` that covers a rectangle."""
    width, height = np.ceil((np.array(high) - low) / CELL_M).astype(int).tolist()
    return GridSpec(CELL_M, width, height, Pose2(*low, 0.0))


def shortest_length(
    lethal: NDArray[np.uint8], spec: GridSpec, points: Sequence[Point], radius_m: float
) -> float | None:
    """Return the length (m) of the shortest path through all points in order.

    None: the disc does not fit at a point or between two points.

    Args:
        lethal: (H, W), 1 = obstacle.
        spec: its geometry.
        points: start and goals (m).
        radius_m: of the disc.
    """
    away = distance_field(lethal, spec.resolution, radius_m + spec.resolution)
    cost = np.where(away < radius_m, LETHAL, 0).astype(np.uint8)
    cells = [spec.cell_of(*point) for point in points]
    if not all(spec.contains(*cell) and cost[cell] == 0 for cell in cells):
        return None
    units = 0
    search = AStar()
    for start, goal in pairwise(cells):
        found = search.search(cost, start, goal)
        if found is None:
            return None
        units += found[1]
    return units / STRAIGHT * spec.resolution


def filled_outlines(
    outlines: Sequence[NDArray[np.float64]], spec: GridSpec
) -> NDArray[np.uint8]:
    """Return (H, W) the cells whose centres lie in a convex outline, counter-clockwise.

    The outlines (N, 2) are in the grid's frame, which is not rotated.
    """
    lethal = np.zeros(spec.shape, np.uint8)
    x0, y0 = spec.origin.x, spec.origin.y
    for outline in outlines:
        low, high = outline.min(axis=0), outline.max(axis=0)
        first = np.floor((low - (x0, y0)) / spec.resolution).astype(int)
        last = np.ceil((high - (x0, y0)) / spec.resolution).astype(int)
        columns = np.arange(max(0, first[0]), min(spec.width, last[0] + 1))
        rows = np.arange(max(0, first[1]), min(spec.height, last[1] + 1))
        xs = x0 + (columns + 0.5) * spec.resolution
        ys = y0 + (rows[:, None] + 0.5) * spec.resolution
        inside = np.ones((len(rows), len(columns)), bool)
        for (ax, ay), (bx, by) in zip(
            outline, np.roll(outline, -1, axis=0), strict=True
        ):
            inside &= (bx - ax) * (ys - ay) - (by - ay) * (xs - ax) >= 0
        lethal[np.ix_(rows, columns)] |= inside.astype(np.uint8)
    return lethal


def shortest_around(
    outlines: Sequence[NDArray[np.float64]], points: Sequence[Point], radius_m: float
) -> float:
    """Return the length (m) of the shortest path around outlines; NaN without one."""
    if not outlines:
        return float(sum(math.dist(a, b) for a, b in pairwise(points)))
    corners = np.concatenate(outlines)
    low, high = corners.min(axis=0) - 1.0, corners.max(axis=0) + 1.0
    spec = grid_between((low[0], low[1]), (high[0], high[1]))
    lethal = filled_outlines(outlines, spec)
    length = shortest_length(lethal, spec, points, radius_m)
    return math.nan if length is None else length
