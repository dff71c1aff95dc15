"""Comparison of a new grid with a map: obstacles that appeared or vanished."""

import math
from typing import NamedTuple

import numpy as np

from navette.files.kernels import kernel
from navette.navigation.grids.alignment import (
    Affine,
    cell_at,
    cell_transform,
    has_lethal,
)
from navette.navigation.grids.checks import at_least, grid_array
from navette.navigation.grids.spec import FREE, LETHAL, Cells, GridSpec
from navette.navigation.grids.windows import CellWindow

_ANY = -128  # least int8: every cell counts, unknown ones too


class MapComparison(NamedTuple):
    """A new grid and a map, compared within a square.

    Attributes:
        remembered: (H, W) int8, the map.
        spec: its geometry.
        seen: (h, w) int8, the new grid.
        seen_spec: its geometry in the map's frame.
        center: (x, y) of the square in the map's frame, m.
        radius_m: half the edge of the square, m.
    """

    remembered: Cells
    spec: GridSpec
    seen: Cells
    seen_spec: GridSpec
    center: tuple[float, float]
    radius_m: float

    def count_appeared(self) -> int:
        """Count new obstacles: lethal cells seen without one on the map.

        A lethal map cell at the place or beside it is the same obstacle: from another
        angle the same wall falls into neighbouring cells.

        Raises:
            InvalidValueError: a negative radius, or arrays that do not match their
                specs.
        """
        remembered, seen = self._checked()
        window = _window(self.seen_spec, self.center, self.radius_m)
        map_T_seen = cell_transform(self.spec, self.seen_spec)
        return _unmatched(seen, window, remembered, map_T_seen, np.int8(_ANY), 1)

    def count_vanished(self, apart_m: float = 0.0) -> int:
        """Count obstacles of the map whose place was seen free.

        A lethal cell seen beside it, or up to ``apart_m`` away, is the same obstacle.
        Errors as of :meth:`count_appeared`.
        """
        remembered, seen = self._checked()
        window = _window(self.spec, self.center, self.radius_m)
        seen_T_map = cell_transform(self.seen_spec, self.spec)
        apart = max(1, math.ceil(apart_m / self.seen_spec.resolution - 1e-6))
        return _unmatched(remembered, window, seen, seen_T_map, np.int8(FREE), apart)

    def _checked(self) -> tuple[Cells, Cells]:
        at_least("radius_m", self.radius_m, 0.0)
        return (
            grid_array("remembered", self.remembered, np.int8, self.spec),
            grid_array("seen", self.seen, np.int8, self.seen_spec),
        )


def _window(spec: GridSpec, center: tuple[float, float], radius_m: float) -> CellWindow:
    row, column = spec.cell_of(*center)
    reach = int(radius_m / spec.resolution)
    return CellWindow(
        min(max(row - reach, 0), spec.height),
        min(max(row + reach + 1, 0), spec.height),
        min(max(column - reach, 0), spec.width),
        min(max(column + reach + 1, 0), spec.width),
    )


@kernel(allocates=False)
def _unmatched(
    grid: Cells,
    window: CellWindow,
    other: Cells,
    other_T_grid: Affine,
    least: np.int8,
    apart: int,
) -> int:
    """Count lethal cells of ``grid`` with none of ``other`` up to ``apart`` cells away.

    Counts only places where ``other`` is at least ``least``.
    """
    height, width = other.shape
    count = 0
    for r in range(window.first_row, window.last_row):
        line = grid[r, window.first_column : window.last_column]
        if not has_lethal(line):
            continue
        for k in range(line.size):
            if line[k] < LETHAL:
                continue
            row, column = cell_at(other_T_grid, r, window.first_column + k)
            if not (0 <= row < height and 0 <= column < width):
                continue
            if other[row, column] >= least and not _lethal_near(
                other, row, column, apart
            ):
                count += 1
    return count


@kernel(allocates=False)
def _lethal_near(grid: Cells, row: int, column: int, apart: int) -> bool:
    """Whether a lethal cell is in the square of cells around (row, column)."""
    height, width = grid.shape
    for r in range(max(row - apart, 0), min(row + apart + 1, height)):
        for c in range(max(column - apart, 0), min(column + apart + 1, width)):
            if grid[r, c] >= LETHAL:
                return True
    return False
