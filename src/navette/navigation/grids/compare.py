"""Comparison of a new grid with a map: obstacles that appeared or vanished."""

from typing import NamedTuple

import numpy as np

from navette.files.kernels import kernel
from navette.navigation.grids.alignment import Affine, align, cell_at, has_lethal
from navette.navigation.grids.checks import at_least, grid_array
from navette.navigation.grids.spec import FREE, LETHAL, Cells, GridSpec
from navette.navigation.grids.windows import CellWindow

_ANY = -128  # least int8: every cell counts, unknown ones too


class Changes(NamedTuple):
    """Numbers of cells in which a new grid and a map disagree about obstacles."""

    appeared: int
    vanished: int


def compare(
    remembered: Cells,
    spec: GridSpec,
    seen: Cells,
    seen_spec: GridSpec,
    *,
    center: tuple[float, float],
    radius_m: float,
) -> Changes:
    """Count contradictions within a square around ``center``.

    ``appeared``: lethal cells of ``seen`` without a lethal map cell at their place or
    beside it. ``vanished``: lethal cells of the map whose place was seen free, without
    a lethal cell seen beside it. The tolerance is one cell, because from another angle
    the same wall falls into neighbouring cells.

    Args:
        remembered: (H, W) int8, the map.
        spec: its geometry.
        seen: (h, w) int8, the new grid.
        seen_spec: its geometry in the map's frame.
        center: (x, y) in the map's frame, m.
        radius_m: half the edge of the square, m.

    Raises:
        InvalidValueError: a negative radius, or arrays that do not match their specs.
    """
    cells = grid_array("remembered", remembered, np.int8, spec)
    new = grid_array("seen", seen, np.int8, seen_spec)
    at_least("radius_m", radius_m, 0.0)
    alignment = align(spec, seen_spec)
    appeared = _unmatched(
        new,
        _window(seen_spec, center, radius_m),
        cells,
        alignment.target_T_source,
        np.int8(_ANY),
    )
    vanished = _unmatched(
        cells,
        _window(spec, center, radius_m),
        new,
        alignment.source_T_target,
        np.int8(FREE),
    )
    return Changes(appeared, vanished)


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
    grid: Cells, window: CellWindow, other: Cells, other_T_grid: Affine, least: np.int8
) -> int:
    """Count lethal cells of ``grid`` without a lethal cell of ``other`` near them.

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
            if other[row, column] >= least and not _lethal_near(other, row, column):
                count += 1
    return count


@kernel(allocates=False)
def _lethal_near(grid: Cells, row: int, column: int) -> bool:
    """Whether a lethal cell is among the nine around (row, column)."""
    height, width = grid.shape
    for r in range(max(row - 1, 0), min(row + 2, height)):
        for c in range(max(column - 1, 0), min(column + 2, width)):
            if grid[r, c] >= LETHAL:
                return True
    return False
