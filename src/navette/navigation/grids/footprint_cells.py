"""Cells that a footprint covers."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Footprint, Pose2
from navette.navigation.grids.exact_clearance import make_outline, signed_distance
from navette.navigation.grids.spec import GridSpec, grid_frame


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
    rows, columns = _span(row, reach, spec.height), _span(column, reach, spec.width)
    cells: NDArray[np.int64] = _covered(
        make_outline(footprint).vertices,
        np.array(pose),
        grid_frame(spec),
        (rows.start, rows.stop, columns.start, columns.stop),
        float(depth_m),
    )
    return cells


@kernel
def _covered(outline: Any, pose: Any, frame: Any, part: Any, depth: float) -> Any:
    """Return the cells (N, 2) of a part of the grid whose centres lie that deep."""
    first_row, last_row, first_column, last_column = part
    cells = np.empty(
        ((last_row - first_row) * (last_column - first_column), 2), np.int64
    )
    count = 0
    c, s = math.cos(pose[2]), math.sin(pose[2])
    for row in range(first_row, last_row):
        for column in range(first_column, last_column):
            gx = (column + 0.5) * frame.resolution
            gy = (row + 0.5) * frame.resolution
            dx = frame.x + frame.cos * gx - frame.sin * gy - pose[0]
            dy = frame.y + frame.sin * gx + frame.cos * gy - pose[1]
            if signed_distance(outline, c * dx + s * dy, c * dy - s * dx) <= -depth:
                cells[count, 0], cells[count, 1] = row, column
                count += 1
    return cells[:count].copy()


def _span(middle: int, reach: int, size: int) -> slice:
    """Return the indices of an axis up to ``reach`` away from ``middle``."""
    first = min(max(middle - reach, 0), size)
    return slice(first, max(first, min(middle + reach + 1, size)))
