"""The cells that a body covers."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.grids import GridSpec


def cells_under(
    footprint: Footprint, pose: Pose2, spec: GridSpec
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows (N,) and columns (N,) of the cells that lie wholly under the footprint.

    Wholly: the cell's centre lies inside the outline, at least half a cell's diagonal
    from it; a wall that the body nearly touches keeps its cells.

    Args:
        footprint: in the base frame.
        pose: of the base in the grid's frame.
        spec: the grid.
    """
    row, column = spec.cell_of(pose.x, pose.y)
    reach = math.ceil(footprint.circumscribed_radius / spec.resolution) + 1
    rows, columns = np.mgrid[
        _span(row, reach, spec.height), _span(column, reach, spec.width)
    ].reshape(2, -1)
    centers = pose.inverse().apply(spec.centers_of(np.column_stack([rows, columns])))
    inside = _deep_inside(footprint, centers, spec.resolution * math.sqrt(0.5))
    return rows[inside], columns[inside]


def _span(middle: int, reach: int, size: int) -> slice:
    """Indices up to ``reach`` away that an axis of ``size`` has; perhaps none."""
    first = min(max(middle - reach, 0), size)
    return slice(first, max(first, min(middle + reach + 1, size)))


def _deep_inside(
    footprint: Footprint, points: NDArray[np.float64], depth: float
) -> NDArray[np.bool_]:
    """Which points (N, 2) lie inside the outline, at least ``depth`` m from it."""
    crossings = np.zeros(len(points), int)
    nearest = np.full(len(points), np.inf)
    corners = np.array(footprint.vertices)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge, to_point = b - a, points - a
        length2 = edge @ edge
        t = np.clip(to_point @ edge / length2, 0, 1) if length2 else np.zeros(1)
        gap = to_point - t[:, None] * edge
        nearest = np.minimum(nearest, np.hypot(gap[:, 0], gap[:, 1]))
        spans = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        # Edges that span the point's height are not level, so edge[1] is not 0.
        slope = edge[0] / edge[1] if edge[1] else 0.0
        crossings += spans & (a[0] + to_point[:, 1] * slope > points[:, 0])
    deep: NDArray[np.bool_] = (crossings % 2 == 1) & (nearest >= depth)
    return deep
