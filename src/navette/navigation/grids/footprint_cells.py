"""Cells that a footprint covers."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.grids.spec import GridSpec


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
    return cells[footprint.contains(centers, depth_m=depth_m)]


def _span(middle: int, reach: int, size: int) -> slice:
    """Return the indices of an axis up to ``reach`` away from ``middle``."""
    first = min(max(middle - reach, 0), size)
    return slice(first, max(first, min(middle + reach + 1, size)))
