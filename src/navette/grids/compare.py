"""Where a new grid contradicts what a map remembers."""

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.grids.alignment import grid_relation, related_cell
from navette.grids.cells import FREE, LETHAL
from navette.grids.checks import at_least, grid_array
from navette.grids.spec import GridSpec


class Changes(NamedTuple):
    """Cells in which a new grid and a map disagree about obstacles."""

    appeared: int
    vanished: int


def compare(
    remembered: NDArray[np.int8],
    spec: GridSpec,
    seen: NDArray[np.int8],
    seen_spec: GridSpec,
    *,
    center: tuple[float, float],
    radius: float,
) -> Changes:
    """Count contradictions within a square around ``center``.

    ``appeared``: lethal cells of ``seen`` with no lethal cell of the map on their
    place or beside it. ``vanished``: lethal cells of the map whose place was seen
    free, with no lethal cell seen beside it. One cell of tolerance, because the same
    wall falls into neighbouring cells from another angle.

    Args:
        remembered: (H, W) int8, the map.
        spec: where it lies.
        seen: (h, w) int8, the new grid.
        seen_spec: where it lies, in the map's frame.
        center: (x, y) in the map's frame, m.
        radius: half the edge of the square, m.
    """
    cells = grid_array("remembered", remembered, np.int8, spec)
    new = grid_array("seen", seen, np.int8, seen_spec)
    at_least("radius", radius, 0.0)
    map_window = _window(spec, center, radius)
    seen_window = _window(seen_spec, center, radius)
    appeared = _unmatched(
        new, cells, seen_window, grid_relation(spec, seen_spec), np.int8(-128)
    )
    vanished = _unmatched(
        cells, new, map_window, grid_relation(seen_spec, spec), np.int8(FREE)
    )
    return Changes(appeared, vanished)


def _window(
    spec: GridSpec, center: tuple[float, float], radius: float
) -> tuple[int, int, int, int]:
    """(first row, last row, first column, last column), the last ones exclusive."""
    row, column = spec.cell_of(*center)
    reach = int(radius / spec.resolution)
    return (
        min(max(row - reach, 0), spec.height),
        min(max(row + reach + 1, 0), spec.height),
        min(max(column - reach, 0), spec.width),
        min(max(column + reach + 1, 0), spec.width),
    )


@njit(cache=True)
def _unmatched(grid: Any, other: Any, window: Any, relation: Any, least: Any) -> int:
    """Lethal cells of ``grid`` with none of ``other``'s beside their place.

    Counted only where ``other`` is at least ``least`` there.
    """
    first_row, last_row, first_column, last_column = window
    height, width = other.shape
    count = 0
    for r in range(first_row, last_row):
        for c in range(first_column, last_column):
            if grid[r, c] < LETHAL:
                continue
            row, column = related_cell(relation, r, c)
            if not (0 <= row < height and 0 <= column < width):
                continue
            if other[row, column] >= least and not _lethal_near(other, row, column):
                count += 1
    return count


@njit(cache=True)
def _lethal_near(grid: Any, row: int, column: int) -> bool:
    """Whether a lethal cell is among the nine around (row, column)."""
    height, width = grid.shape
    for r in range(max(row - 1, 0), min(row + 2, height)):
        for c in range(max(column - 1, 0), min(column + 2, width)):
            if grid[r, c] >= LETHAL:
                return True
    return False
