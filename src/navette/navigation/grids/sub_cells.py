"""Where in a cell beams ended: an 8 × 8 bit mask per cell.

A cell of 0.1 m is too coarse for a door with 0.06 m to spare on each side. A lethal
cell with a mask is therefore as many obstacle points as bits are set, each the centre
of a sub-cell; one without a mask (a loaded map, a costmap without points) is its
centre with half a cell around it.
"""

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids.spec import GridSpec

SUB_CELLS = 8
"""Sub-cells along an edge of a cell; 64 bits in all."""

_CIRCLE_POINTS = 8

Masks = NDArray[np.uint64]
Points = NDArray[np.float64]


def mark_points(masks: Masks, spec: GridSpec, points: Points) -> NDArray[np.int64]:
    """Replace the masks of the cells that contain points; return these cells (M, 2).

    The points of a cell are those of its newest scan: older ones may be of an object
    that moved, and their noise would make walls thicker with every scan.

    Args:
        masks: (H, W), changed in place.
        spec: its geometry.
        points: (N, 2) in the grid's frame, m; those outside are ignored.
    """
    uv = spec.origin.inverse().apply(points) / spec.resolution
    inside = ((uv >= 0) & (uv < (spec.width, spec.height))).all(axis=1)
    uv = uv[inside]
    column, row = uv.astype(np.int64).T
    part = ((uv % 1.0) * SUB_CELLS).astype(np.int64)
    bits = np.uint64(1) << (part[:, 1] * SUB_CELLS + part[:, 0]).astype(np.uint64)
    masks[row, column] = 0
    np.bitwise_or.at(masks, (row, column), bits)
    cells = np.unique(row * spec.width + column)
    return np.column_stack(np.divmod(cells, spec.width))


def points_of(masks: Masks, spec: GridSpec, cells: NDArray[np.int64]) -> Points:
    """Return the marked points (N, 2) of cells (M, 2) in the grid's frame, m."""
    return points_by_cell(masks, spec, cells)[0]


def points_by_cell(
    masks: Masks, spec: GridSpec, cells: NDArray[np.int64]
) -> tuple[Points, NDArray[np.int64]]:
    """Return :func:`points_of`, and for each point the index (N,) of its cell."""
    row, column = cells.T
    bits = np.arange(SUB_CELLS**2, dtype=np.uint64)
    which, bit = np.nonzero((masks[row, column][:, None] >> bits) & np.uint64(1))
    u = column[which] + (bit % SUB_CELLS + 0.5) / SUB_CELLS
    v = row[which] + (bit // SUB_CELLS + 0.5) / SUB_CELLS
    return spec.origin.apply(np.column_stack([u, v]) * spec.resolution), which


def cell_points(
    masks: Masks, spec: GridSpec, cells: NDArray[np.int64], radius_m: float
) -> Points:
    """Return points (N, 2), m, that with this radius stand for lethal cells (M, 2).

    These are the marked points, and of a cell without one a circle of points about its
    centre: with the radius they cover the border of half a cell.
    """
    unmarked = cells[masks[cells[:, 0], cells[:, 1]] == 0]
    around = np.arange(_CIRCLE_POINTS) * (2 * np.pi / _CIRCLE_POINTS)
    away = max(0.0, 0.5 * spec.resolution - radius_m)
    circle = away * np.column_stack([np.cos(around), np.sin(around)])
    circles = spec.centers_of(unmarked)[:, None, :] + circle
    return np.concatenate([points_of(masks, spec, cells), circles.reshape(-1, 2)])


def point_radius(resolution: float) -> float:
    """Return half the edge of a sub-cell, m."""
    return 0.5 * resolution / SUB_CELLS
