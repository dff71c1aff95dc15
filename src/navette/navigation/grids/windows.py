"""Windows of a grid: the rows and columns of a part of its cells."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids.spec import UNKNOWN, GridSpec

_STRIP = 256  # rows


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
        uv = spec.origin.inverse().apply(points) / spec.resolution
        left, top = (math.floor(least) for least in uv.min(axis=0))
        right, bottom = (math.floor(most) + 1 for most in uv.max(axis=0))
        return cls(top, bottom, left, right).grown(margin, spec.shape)

    @classmethod
    def of(cls, mask: NDArray[np.bool_]) -> "CellWindow":
        """Return the window around the true cells of a mask (H, W); may be empty."""
        rows = np.flatnonzero(mask.any(axis=1))
        if rows.size == 0:
            return cls(0, 0, 0, 0)
        first_row, last_row = int(rows[0]), int(rows[-1]) + 1
        columns = np.flatnonzero(mask[first_row:last_row].any(axis=0))
        return cls(first_row, last_row, int(columns[0]), int(columns[-1]) + 1)

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
        window = NO_CELLS
        for first in range(0, cells.shape[0], _STRIP):  # a small mask at a time
            strip = cls.of(cells[first : first + _STRIP] != UNKNOWN)
            window = window.union(strip.shifted(first, 0))
        return window

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

    def shifted(self, rows: int, columns: int) -> "CellWindow":
        """Return the same cells in a grid that begins so many cells earlier."""
        return CellWindow(
            self.first_row + rows,
            self.last_row + rows,
            self.first_column + columns,
            self.last_column + columns,
        )


NO_CELLS = CellWindow(0, 0, 0, 0)
