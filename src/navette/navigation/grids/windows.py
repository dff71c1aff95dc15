"""Windows of a grid: the rows and columns of a part of its cells."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.grids.spec import UNKNOWN, GridFrame, GridSpec, grid_frame


class CellWindow(NamedTuple):
    """Rows and columns of a part of a grid; the last ones are exclusive."""

    first_row: int
    last_row: int
    first_column: int
    last_column: int

    @classmethod
    def whole(cls, shape: tuple[int, ...]) -> "CellWindow":
        """Return the window of all cells of a grid of ``shape``."""
        return cls(0, shape[0], 0, shape[1])

    @classmethod
    def around(
        cls, spec: GridSpec, points: NDArray[np.float64], margin: int = 0
    ) -> "CellWindow":
        """Return the cells that contain points (N, 2), m, and ``margin`` more."""
        left, right, top, bottom = _bounds(points, grid_frame(spec))
        return cls(
            math.floor(top),
            math.floor(bottom) + 1,
            math.floor(left),
            math.floor(right) + 1,
        ).grown(margin, spec.shape)

    @classmethod
    def of_cells(cls, cells: NDArray[np.int64]) -> "CellWindow":
        """Return the window around cells (N, 2) row, column; may be empty."""
        if not len(cells):
            return NO_CELLS
        top, left = cells.min(axis=0).tolist()
        bottom, right = cells.max(axis=0).tolist()
        return cls(top, bottom + 1, left, right + 1)

    @classmethod
    def of_known(cls, cells: NDArray[np.int8]) -> "CellWindow":
        """Return the smallest window of all cells (H, W) that are not unknown."""
        window = cls(*_known_window(cells))
        return NO_CELLS if window.is_empty else window

    @property
    def shape(self) -> tuple[int, int]:
        """(rows, columns)."""
        return self.last_row - self.first_row, self.last_column - self.first_column

    @property
    def slices(self) -> tuple[slice, slice]:
        """Return the index of the window in an array."""
        return (
            slice(self.first_row, self.last_row),
            slice(self.first_column, self.last_column),
        )

    def spec_in(self, spec: GridSpec) -> GridSpec:
        """Return the geometry of the window in a grid."""
        x, y = self.first_column * spec.resolution, self.first_row * spec.resolution
        height, width = self.shape
        return GridSpec(spec.resolution, width, height, spec.origin @ Pose2(x, y, 0.0))

    @property
    def is_empty(self) -> bool:
        return self.last_row <= self.first_row or self.last_column <= self.first_column

    def grown(self, cells: int, shape: tuple[int, ...]) -> "CellWindow":
        """Return the window with ``cells`` more on each side, within a grid."""
        first_row = min(max(self.first_row - cells, 0), shape[0])
        first_column = min(max(self.first_column - cells, 0), shape[1])
        return CellWindow(
            first_row,
            max(first_row, min(self.last_row + cells, shape[0])),
            first_column,
            max(first_column, min(self.last_column + cells, shape[1])),
        )

    def contains(self, other: "CellWindow") -> bool:
        """Return whether all cells of another window are in this one."""
        return self.union(other) == self

    def union(self, other: "CellWindow") -> "CellWindow":
        """Return the smallest window that contains both."""
        if self.is_empty or other.is_empty:
            return other if self.is_empty else self
        return CellWindow(
            min(self.first_row, other.first_row),
            max(self.last_row, other.last_row),
            min(self.first_column, other.first_column),
            max(self.last_column, other.last_column),
        )

    def intersection(self, other: "CellWindow") -> "CellWindow":
        """Return the window of the cells that are in both; may be empty."""
        return CellWindow(
            max(self.first_row, other.first_row),
            min(self.last_row, other.last_row),
            max(self.first_column, other.first_column),
            min(self.last_column, other.last_column),
        )

    def shifted(self, rows: int, columns: int) -> "CellWindow":
        """Return the same cells in a grid that begins so many cells earlier."""
        return CellWindow(
            self.first_row + rows,
            self.last_row + rows,
            self.first_column + columns,
            self.last_column + columns,
        )


NO_CELLS = CellWindow(0, 0, 0, 0)


@kernel(allocates=False)
def _bounds(points: Any, frame: GridFrame) -> tuple[float, float, float, float]:
    """Return the least and the largest u, then v, of points (N, 2), in cells."""
    left = top = np.inf
    right = bottom = -np.inf
    for k in range(points.shape[0]):
        dx, dy = points[k, 0] - frame.x, points[k, 1] - frame.y
        u, v = frame.cos * dx + frame.sin * dy, frame.cos * dy - frame.sin * dx
        left, right = min(left, u), max(right, u)
        top, bottom = min(top, v), max(bottom, v)
    edge = frame.resolution
    return left / edge, right / edge, top / edge, bottom / edge


@kernel(allocates=False)
def _known_window(cells: Any) -> tuple[int, int, int, int]:
    height, width = cells.shape
    top, bottom, left, right = height, 0, width, 0
    for row in range(height):
        line = cells[row]
        if not _has_known(line):
            continue
        top, bottom = min(top, row), row + 1
        if _has_known(line[:left]):
            left = 0
            while line[left] == UNKNOWN:
                left += 1
        if _has_known(line[right:]):
            right = width
            while line[right - 1] == UNKNOWN:
                right -= 1
    return top, bottom, left, right


@kernel(allocates=False)
def _has_known(line: Any) -> bool:
    known = False  # vectorised
    for k in range(line.size):
        known |= line[k] != UNKNOWN
    return known
