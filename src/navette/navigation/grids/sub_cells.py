"""Where in a cell beams ended: an 8 × 8 bit mask per cell.

A cell of 0.1 m is too coarse for a door with 0.06 m to spare on each side. A lethal
cell with a mask is therefore as many obstacle points as bits are set, each the centre
of a sub-cell; one without a mask (a loaded map, a costmap without points) is its
centre with half a cell around it.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids.spec import LETHAL, Cells, GridSpec, grid_frame
from navette.navigation.grids.windows import CellWindow

SUB_CELLS = 8
"""Sub-cells along an edge of a cell; 64 bits in all."""

_CIRCLE_POINTS = 8
_AROUND = np.arange(_CIRCLE_POINTS) * (2 * np.pi / _CIRCLE_POINTS)
_CIRCLE = np.column_stack([np.cos(_AROUND), np.sin(_AROUND)])

Masks = NDArray[np.uint64]
Points = NDArray[np.float64]

NO_POINTS = np.empty((0, 2))


def mark_points(masks: Masks, spec: GridSpec, points: Points) -> NDArray[np.int64]:
    """Replace the masks of the cells that contain points; return these cells (M, 2).

    A cell has the points of its newest scan only: older points may belong to an object
    that moved, and their noise would thicken walls with every scan.

    Args:
        masks: (H, W), changed in place.
        spec: its geometry.
        points: (N, 2) in the grid's frame, m; those outside are ignored.
    """
    cells: NDArray[np.int64] = _mark(masks, cell_coordinates(spec, points), 0, 0)
    return cells


def points_by_cell(
    masks: Masks,
    spec: GridSpec,
    cells: NDArray[np.int64],
    first: tuple[int, int] = (0, 0),
) -> tuple[Points, NDArray[np.int64]]:
    """Return the marked points (N, 2) of cells (M, 2), m, and the cell (N,) of each.

    ``first``: row and column of the grid at which the masks begin.
    """
    uv, which = _points_by_cell(masks, np.ascontiguousarray(cells, np.int64), *first)
    return spec.origin.apply(uv * spec.resolution), which


def marked_points(
    masks: Masks, spec: GridSpec, cells: Cells, window: CellWindow
) -> tuple[Points, NDArray[np.int64], NDArray[np.int64]]:
    """Return the lethal cells with marked points in a window, and their points.

    Args:
        masks: (H, W).
        spec: its geometry.
        cells: (H, W) −1 unknown, 0 free … 100 lethal.
        window: the cells to search.

    Returns:
        Points (N, 2) in the grid's frame, m, row by row; the index (N,) of the cell of
        each; the cells (M, 2) row, column.
    """
    found = _lethal_marked(masks, cells, window)
    points, which = points_by_cell(masks, spec, found)
    return points, which, found


def cell_points(
    masks: Masks,
    spec: GridSpec,
    cells: NDArray[np.int64],
    radius_m: float,
    first: tuple[int, int] = (0, 0),
) -> Points:
    """Return points (N, 2), m, that with this radius stand for lethal cells (M, 2).

    These are the marked points, and of a cell without one a circle of points about its
    centre: with the radius they cover the border of half a cell. ``first`` as in
    :func:`points_by_cell`.
    """
    points: Points = _cell_points(
        masks,
        np.ascontiguousarray(cells, np.int64),
        *first,
        grid_frame(spec),
        _circle(spec, radius_m),
    )
    return points


def _circle(spec: GridSpec, radius_m: float) -> Points:
    """Return points (N, 2), m, about a cell's centre that stand for the cell."""
    return max(0.0, 0.5 * spec.resolution - radius_m) * _CIRCLE


def local_cell_points(
    uv: Points, spec: GridSpec, centers: Points, radius_m: float
) -> Points:
    """Return :func:`cell_points` of a few lethal cells near each other.

    Args:
        uv: (N, 2) the grid's points as :func:`cell_coordinates`.
        spec: geometry of the grid.
        centers: (M, 2) in the grid's frame, m: the lethal cells.
        radius_m: of each point.
    """
    if not len(centers):
        return NO_POINTS
    points: Points = _local_points(
        uv, centers, grid_frame(spec), _circle(spec, radius_m)
    )
    return points


def cell_coordinates(spec: GridSpec, points: Points) -> Points:
    """Return points (N, 2), m, as u, v in cells from the grid's corner."""
    return np.ascontiguousarray(spec.origin.inverse().apply(points) / spec.resolution)


def point_radius(resolution: float) -> float:
    """Return half the edge of a sub-cell, m."""
    return 0.5 * resolution / SUB_CELLS


@kernel
def _mark(masks: Any, uv: Any, first_row: int, first_column: int) -> Any:
    """Mark points (N, 2) u, v in cells; return the cells (M, 2), row by row.

    The masks begin at a row and column of the grid.
    """
    height, width = masks.shape
    low_u, high_u = float(first_column), float(first_column + width)
    low_v, high_v = float(first_row), float(first_row + height)
    for k in range(uv.shape[0]):
        u, v = uv[k, 0], uv[k, 1]
        if low_u <= u < high_u and low_v <= v < high_v:
            masks[int(v) - first_row, int(u) - first_column] = 0
    indices = np.empty(uv.shape[0], np.int64)
    count = 0
    for k in range(uv.shape[0]):
        u, v = uv[k, 0], uv[k, 1]
        if not (low_u <= u < high_u and low_v <= v < high_v):
            continue
        row, column = int(v) - first_row, int(u) - first_column
        part = int(v % 1.0 * SUB_CELLS) * SUB_CELLS + int(u % 1.0 * SUB_CELLS)
        if masks[row, column] == 0:
            indices[count] = row * width + column
            count += 1
        masks[row, column] |= np.uint64(1) << np.uint64(part)
    ordered = np.sort(indices[:count])
    cells = np.empty((count, 2), np.int64)
    for k in range(count):
        cells[k, 0] = ordered[k] // width + first_row
        cells[k, 1] = ordered[k] % width + first_column
    return cells


@kernel
def _local_points(uv: Any, centers: Any, frame: Any, circle: Any) -> Any:
    """Return the points of the lethal cells with these centres (M, 2)."""
    cells = np.empty(centers.shape, np.int64)
    for k in range(centers.shape[0]):
        dx, dy = centers[k, 0] - frame.x, centers[k, 1] - frame.y
        u = frame.cos * dx + frame.sin * dy
        v = frame.cos * dy - frame.sin * dx
        cells[k, 0] = math.floor(v / frame.resolution)
        cells[k, 1] = math.floor(u / frame.resolution)
    first_row, last_row = cells[0, 0], cells[0, 0]
    first_column, last_column = cells[0, 1], cells[0, 1]
    for k in range(cells.shape[0]):
        first_row, last_row = min(first_row, cells[k, 0]), max(last_row, cells[k, 0])
        first_column = min(first_column, cells[k, 1])
        last_column = max(last_column, cells[k, 1])
    shape = (last_row - first_row + 1, last_column - first_column + 1)
    masks = np.zeros(shape, np.uint64)
    _add_marks(masks, uv, first_row, first_column)
    return _cell_points(masks, cells, first_row, first_column, frame, circle)


@kernel
def _add_marks(masks: Any, uv: Any, first_row: int, first_column: int) -> None:
    """Mark points (N, 2) u, v in cells, as :func:`_mark`, without listing the cells."""
    height, width = masks.shape
    low_u, high_u = float(first_column), float(first_column + width)
    low_v, high_v = float(first_row), float(first_row + height)
    for k in range(uv.shape[0]):
        u, v = uv[k, 0], uv[k, 1]
        if low_u <= u < high_u and low_v <= v < high_v:
            part = int(v % 1.0 * SUB_CELLS) * SUB_CELLS + int(u % 1.0 * SUB_CELLS)
            bit = np.uint64(1) << np.uint64(part)
            masks[int(v) - first_row, int(u) - first_column] |= bit


@kernel
def _points_by_cell(masks: Any, cells: Any, first_row: int, first_column: int) -> Any:
    """Return the marked points (N, 2) u, v in cells, and the index of each one's."""
    count = 0
    for k in range(cells.shape[0]):
        mask = masks[cells[k, 0] - first_row, cells[k, 1] - first_column]
        while mask != 0:
            mask &= mask - np.uint64(1)
            count += 1
    points, which = np.empty((count, 2)), np.empty(count, np.int64)
    found = 0
    for k in range(cells.shape[0]):
        row, column = cells[k, 0], cells[k, 1]
        mask = masks[row - first_row, column - first_column]
        bit = 0
        while mask != 0:
            if mask & np.uint64(1):
                points[found, 0] = column + (bit % SUB_CELLS + 0.5) / SUB_CELLS
                points[found, 1] = row + (bit // SUB_CELLS + 0.5) / SUB_CELLS
                which[found] = k
                found += 1
            mask >>= np.uint64(1)
            bit += 1
    return points, which


@kernel
def _cell_points(
    masks: Any, cells: Any, first_row: int, first_column: int, frame: Any, circle: Any
) -> Points:
    """Return the marked points, then a circle about each cell (M, 2) without one."""
    marked, _ = _points_by_cell(masks, cells, first_row, first_column)
    empty = 0
    for k in range(cells.shape[0]):
        empty += masks[cells[k, 0] - first_row, cells[k, 1] - first_column] == 0
    points = np.empty((marked.shape[0] + empty * circle.shape[0], 2))
    for k in range(marked.shape[0]):
        u, v = marked[k, 0] * frame.resolution, marked[k, 1] * frame.resolution
        points[k, 0] = frame.x + frame.cos * u - frame.sin * v
        points[k, 1] = frame.y + frame.sin * u + frame.cos * v
    at = marked.shape[0]
    for k in range(cells.shape[0]):
        row, column = cells[k, 0], cells[k, 1]
        if masks[row - first_row, column - first_column] != 0:
            continue
        u, v = (column + 0.5) * frame.resolution, (row + 0.5) * frame.resolution
        x = frame.x + frame.cos * u - frame.sin * v
        y = frame.y + frame.sin * u + frame.cos * v
        for i in range(circle.shape[0]):
            points[at, 0], points[at, 1] = x + circle[i, 0], y + circle[i, 1]
            at += 1
    return points


def _lethal_marked(masks: Masks, cells: Cells, window: CellWindow) -> NDArray[np.int64]:
    """Return the lethal cells (M, 2) of a window that have marked points."""
    part = cells[window.slices]
    lethal_at = np.flatnonzero(part >= LETHAL)
    rows, columns = np.divmod(lethal_at, max(part.shape[1], 1))
    rows += window.first_row
    columns += window.first_column
    is_marked = masks[rows, columns] != 0
    return np.column_stack([rows[is_marked], columns[is_marked]])
