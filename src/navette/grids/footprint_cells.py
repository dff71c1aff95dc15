"""Cells that a footprint covers."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.grids.spec import GridSpec


def cells_in_footprint(
    footprint: Footprint, pose: Pose2, spec: GridSpec, *, depth_m: float = 0.0
) -> NDArray[np.int64]:
    """Return cells (N, 2) row, column whose centres lie inside the footprint.

    Args:
        footprint: outline in the base frame.
        pose: of the base in the grid's frame.
        spec: the grid.
        depth_m: least distance of a centre from the outline.
    """
    row, column = spec.cell_of(pose.x, pose.y)
    reach = math.ceil(footprint.circumscribed_radius / spec.resolution) + 1
    rows, columns = np.mgrid[
        _span(row, reach, spec.height), _span(column, reach, spec.width)
    ]
    cells = np.stack([rows, columns], axis=-1).reshape(-1, 2)
    centers = pose.inverse().apply(spec.centers_of(cells))
    return cells[_is_inside(footprint, centers, depth_m)]


def _span(middle: int, reach: int, size: int) -> slice:
    """Return the indices of an axis up to ``reach`` away from ``middle``."""
    first = min(max(middle - reach, 0), size)
    return slice(first, max(first, min(middle + reach + 1, size)))


def _is_inside(
    footprint: Footprint, points: NDArray[np.float64], depth_m: float
) -> NDArray[np.bool_]:
    """Return which points (N, 2) lie inside: an odd number of edges to one side."""
    inside = np.zeros(len(points), np.bool_)
    nearest = np.full(len(points), np.inf)
    corners = np.array(footprint.vertices)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge, to_point = b - a, points - a
        length2 = edge @ edge
        t = np.clip(to_point @ edge / length2, 0, 1) if length2 else np.zeros(1)
        gap = to_point - t[:, None] * edge
        nearest = np.minimum(nearest, np.hypot(gap[:, 0], gap[:, 1]))
        spans = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        # An edge that spans the point's y has edge[1] != 0.
        slope = edge[0] / edge[1] if edge[1] else 0.0
        inside ^= spans & (a[0] + to_point[:, 1] * slope > points[:, 0])
    return np.asarray(inside & (nearest >= depth_m))
