"""Where in a cell beams ended: an 8 × 8 bit mask per cell.

A cell of 0.1 m is too coarse for a door with 0.06 m to spare on each side. A lethal
cell with a mask is therefore as many obstacle points as bits are set, each the centre
of a sub-cell; one without a mask (a loaded map, a costmap without points) is its
centre with half a cell around it.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids.spec import GridSpec, grid_frame

SUB_CELLS = 8
"""Sub-cells along an edge of a cell; 64 bits in all."""

_CIRCLE_POINTS = 8
_AROUND = np.arange(_CIRCLE_POINTS) * (2 * np.pi / _CIRCLE_POINTS)
_CIRCLE = np.column_stack([np.cos(_AROUND), np.sin(_AROUND)])

Masks = NDArray[np.uint64]
Points = NDArray[np.float64]

NO_POINTS = np.empty((0, 2))

_NO_CELL = np.iinfo(np.int64).min


def mark_points(masks: Masks, spec: GridSpec, points: Points) -> NDArray[np.int64]:
    """Replace the masks of the cells that contain points; return these cells (M, 2).

    A cell has the points of its newest scan only: older points may belong to an object
    that moved, and their noise would thicken walls with every scan.

    Args:
        masks: (H, W), changed in place.
        spec: its geometry.
        points: (N, 2) in the grid's frame, m; those outside are ignored.
    """
    cells: NDArray[np.int64] = _mark(masks, cell_coordinates(spec, points))
    return cells


class CellMarks(NamedTuple):
    """Masks of the cells of a grid that have marked points, for looking up a few.

    A hash table with linear probing, as long as a power of two.

    Attributes:
        cells: (N,) row times 2³² plus column; ``_NO_CELL`` where the table is empty.
        masks: (N,) of these cells.
    """

    cells: NDArray[np.int64]
    masks: Masks

    @classmethod
    def of(cls, spec: GridSpec, points: Points) -> "CellMarks":
        """Args: geometry of the grid; points (N, 2) in its frame, m.

        Points outside of the grid are ignored.
        """
        size = 1 << (2 * len(points)).bit_length()
        marks = cls(np.full(size, _NO_CELL), np.zeros(size, np.uint64))
        _add_marks(marks, points, grid_frame(spec), spec.shape)
        return marks

    def points_by_cell(
        self, spec: GridSpec, centers: Points, radius_m: float
    ) -> tuple[NDArray[np.int64], Points]:
        """Return points as :func:`cell_points` for lethal cells, cell by cell.

        Args:
            spec: geometry of the grid.
            centers: (M, 2) of the cells, m.
            radius_m: of each point.

        Returns:
            Index (M + 1,) of the first point of each cell, and the points (N, 2), m.
        """
        circle = _circle(spec, radius_m)
        first, points = _marked_or_circle(self, centers, grid_frame(spec), circle)
        return first, points


def cell_points(
    masks: Masks, spec: GridSpec, cells: NDArray[np.int64], radius_m: float
) -> Points:
    """Return points (N, 2), m, that with this radius stand for lethal cells (M, 2).

    These are the marked points, and of a cell without one a circle of points about its
    centre: with the radius they cover the border of half a cell.

    Args:
        masks: (M,) of the cells.
        spec: geometry of the grid.
        cells: (M, 2) row and column.
        radius_m: of each point.
    """
    points: Points = _cell_points(
        masks,
        np.ascontiguousarray(cells, np.int64),
        grid_frame(spec),
        _circle(spec, radius_m),
    )
    return points


def _circle(spec: GridSpec, radius_m: float) -> Points:
    """Return points (N, 2), m, about a cell's centre that stand for the cell."""
    return max(0.0, 0.5 * spec.resolution - radius_m) * _CIRCLE


def cell_coordinates(spec: GridSpec, points: Points) -> Points:
    """Return points (N, 2), m, as u, v in cells from the grid's corner."""
    return np.ascontiguousarray(spec.origin.inverse().apply(points) / spec.resolution)


def point_radius(resolution: float) -> float:
    """Return half the edge of a sub-cell, m."""
    return 0.5 * resolution / SUB_CELLS


@kernel
def _mark(masks: Any, uv: Any) -> Any:
    """Mark points (N, 2) u, v in cells; return the cells (M, 2), row by row."""
    height, width = masks.shape
    for k in range(uv.shape[0]):
        u, v = uv[k, 0], uv[k, 1]
        if 0.0 <= u < width and 0.0 <= v < height:
            masks[int(v), int(u)] = 0
    indices = np.empty(uv.shape[0], np.int64)
    count = 0
    for k in range(uv.shape[0]):
        u, v = uv[k, 0], uv[k, 1]
        if not (0.0 <= u < width and 0.0 <= v < height):
            continue
        row, column = int(v), int(u)
        part = int(v % 1.0 * SUB_CELLS) * SUB_CELLS + int(u % 1.0 * SUB_CELLS)
        if masks[row, column] == 0:
            indices[count] = row * width + column
            count += 1
        masks[row, column] |= np.uint64(1) << np.uint64(part)
    ordered = np.sort(indices[:count])
    cells = np.empty((count, 2), np.int64)
    for k in range(count):
        cells[k, 0], cells[k, 1] = ordered[k] // width, ordered[k] % width
    return cells


@kernel(allocates=False)
def _slot(cells: Any, row: int, column: int) -> int:
    """Return where a cell is in a table of :class:`CellMarks`, or belongs."""
    cell = row * (1 << 32) + column
    at = (row * 73856093 ^ column * 19349663) & (cells.size - 1)
    while cells[at] != cell and cells[at] != _NO_CELL:
        at = (at + 1) & (cells.size - 1)
    return int(at)


@kernel(allocates=False)
def mask_at(marks: Any, row: int, column: int) -> np.uint64:
    """Return the mask of a cell in a table of :class:`CellMarks`, or 0."""
    mask: np.uint64 = marks.masks[_slot(marks.cells, row, column)]
    return mask


@kernel
def _add_marks(marks: Any, points: Any, frame: Any, shape: tuple[int, int]) -> None:
    height, width = shape
    for k in range(points.shape[0]):
        u, v = _in_cells(points, k, frame)
        if not (0.0 <= u < width and 0.0 <= v < height):
            continue
        row, column = math.floor(v), math.floor(u)
        at = _slot(marks.cells, row, column)
        part_u, part_v = int((u - column) * SUB_CELLS), int((v - row) * SUB_CELLS)
        part = min(part_v, SUB_CELLS - 1) * SUB_CELLS + min(part_u, SUB_CELLS - 1)
        marks.cells[at] = row * (1 << 32) + column
        marks.masks[at] |= np.uint64(1) << np.uint64(part)


@kernel
def _in_cells(points: Any, k: int, frame: Any) -> Any:
    """Return u, v of a point."""
    dx, dy = points[k, 0] - frame.x, points[k, 1] - frame.y
    u = (frame.cos * dx + frame.sin * dy) / frame.resolution
    v = (frame.cos * dy - frame.sin * dx) / frame.resolution
    return u, v


@kernel
def _marked_or_circle(marks: Any, centers: Any, frame: Any, circle: Any) -> Any:
    masks = np.empty(centers.shape[0], np.uint64)
    first = np.zeros(centers.shape[0] + 1, np.int64)
    for k in range(centers.shape[0]):
        u, v = _in_cells(centers, k, frame)
        masks[k] = mask_at(marks, math.floor(v), math.floor(u))
        first[k + 1] = first[k] + (_bits(masks[k]) or circle.shape[0])
    points = np.empty((first[-1], 2))
    for k in range(centers.shape[0]):
        u, v = _in_cells(centers, k, frame)
        row, column, at = math.floor(v), math.floor(u), first[k]
        if masks[k] == 0:
            x, y = _from_cells(column + 0.5, row + 0.5, frame)
            for i in range(circle.shape[0]):
                points[at + i, 0], points[at + i, 1] = (
                    x + circle[i, 0],
                    y + circle[i, 1],
                )
        for part in range(SUB_CELLS * SUB_CELLS):
            if (masks[k] >> np.uint64(part)) & np.uint64(1):
                part_u = column + (part % SUB_CELLS + 0.5) / SUB_CELLS
                part_v = row + (part // SUB_CELLS + 0.5) / SUB_CELLS
                points[at, 0], points[at, 1] = _from_cells(part_u, part_v, frame)
                at += 1
    return first, points


@kernel(allocates=False)
def _bits(mask: Any) -> int:
    """Return how many bits of a mask are set."""
    count = 0
    while mask != 0:
        mask &= mask - np.uint64(1)
        count += 1
    return count


@kernel(allocates=False)
def _from_cells(u: float, v: float, frame: Any) -> tuple[float, float]:
    """Return the position, m, of u, v in cells."""
    u, v = u * frame.resolution, v * frame.resolution
    x = frame.x + frame.cos * u - frame.sin * v
    return x, frame.y + frame.sin * u + frame.cos * v


@kernel
def points_by_cell(masks: Any, cells: Any) -> Any:
    """Return the marked points (N, 2) u, v in cells, and the index of each one's."""
    count = 0
    for k in range(masks.size):
        mask = masks[k]
        while mask != 0:
            mask &= mask - np.uint64(1)
            count += 1
    points, which = np.empty((count, 2)), np.empty(count, np.int64)
    found = 0
    for k in range(masks.size):
        row, column, mask = cells[k, 0], cells[k, 1], masks[k]
        for part_row in range(SUB_CELLS):
            bits = (mask >> np.uint64(SUB_CELLS * part_row)) & np.uint64(0xFF)
            if bits == 0:
                continue
            for part_column in range(SUB_CELLS):
                if (bits >> np.uint64(part_column)) & np.uint64(1):
                    points[found, 0] = column + (part_column + 0.5) / SUB_CELLS
                    points[found, 1] = row + (part_row + 0.5) / SUB_CELLS
                    which[found] = k
                    found += 1
    return points, which


@kernel
def _cell_points(masks: Any, cells: Any, frame: Any, circle: Any) -> Points:
    """Return the marked points, then a circle about each cell (M, 2) without one."""
    marked, _ = points_by_cell(masks, cells)
    empty = 0
    for k in range(masks.size):
        empty += masks[k] == 0
    points = np.empty((marked.shape[0] + empty * circle.shape[0], 2))
    for k in range(marked.shape[0]):
        u, v = marked[k, 0] * frame.resolution, marked[k, 1] * frame.resolution
        points[k, 0] = frame.x + frame.cos * u - frame.sin * v
        points[k, 1] = frame.y + frame.sin * u + frame.cos * v
    at = marked.shape[0]
    for k in range(masks.size):
        if masks[k] != 0:
            continue
        u = (cells[k, 1] + 0.5) * frame.resolution
        v = (cells[k, 0] + 0.5) * frame.resolution
        x = frame.x + frame.cos * u - frame.sin * v
        y = frame.y + frame.sin * u + frame.cos * v
        for i in range(circle.shape[0]):
            points[at, 0], points[at, 1] = x + circle[i, 0], y + circle[i, 1]
            at += 1
    return points
