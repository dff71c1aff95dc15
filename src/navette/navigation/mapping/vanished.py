"""Obstacles that beams passed: objects that moved away, also at a distance.

At a distance, neighbouring beams pass a thin post on both sides and mark its cell free
without having measured it, so a free cell there proves nothing. A cell keeps where
beams ended in it. These points are those of an obstacle, at least of a post of the
radius R, whose centre is at most R from their middle. A beam that passes the middle at
a distance s < R, and ends beyond, leaves only the directions away from it: a centre at
an angle of at most ``acos((R - s) / R)`` to the beam's normal. Beams that passed on
several sides, in scans from any place, leave no direction: the obstacle is gone.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import CellWindow, MarkedCells, RowSpans, SparseGrid
from navette.navigation.grids.sub_cells import SUB_CELLS
from navette.navigation.mapping.scan_beams import (
    ALL_DIRECTIONS,
    ScanBeams,
    has_echo,
    possible_directions,
)

_TIMES = 3
"""Least number of scans that passed before a cell is free, against faulty scans."""


class PassedCells(NamedTuple):
    """Marked lethal cells (N, 2) without an echo: obstacles that are gone, or not."""

    gone: NDArray[np.int64]
    kept: NDArray[np.int64]


class VanishedCells:
    """Where, seen from each cell's points, no obstacle was found to be since its echo.

    ``shape`` is that of the map.
    """

    def __init__(self, shape: tuple[int, int]) -> None:
        self._passes = SparseGrid(shape, np.uint8)
        self._refuted = SparseGrid(shape, np.uint32)
        self.pending = 0
        """Number of cells that beams of the last scan passed, and that are not free."""

    def grow(
        self, pad: tuple[tuple[int, int], tuple[int, int]], written: RowSpans
    ) -> None:
        """Add cells around, as :func:`numpy.pad` does."""
        self._passes.grow(pad, written)
        self._refuted.grow(pad, written)

    def update(
        self,
        marked: MarkedCells,
        window: CellWindow,
        beams: ScanBeams,
        resolution_m: float,
    ) -> PassedCells:
        """Return which obstacles are gone after a scan.

        Args:
            marked: the lethal cells of the map.
            window: the cells that the scan may show.
            beams: of the scan.
            resolution_m: edge of a cell of the map.
        """
        arrays = self._passes.cells, self._refuted.cells
        edge_m = resolution_m / SUB_CELLS
        gone, kept, self.pending = _judge(
            marked.cells, marked.middles, window, beams, edge_m, *arrays
        )
        return PassedCells(gone, kept)


@kernel
def _judge(
    cells: Any,
    middles: Any,
    window: CellWindow,
    beams: ScanBeams,
    edge_m: float,
    passes: Any,
    refuted: Any,
) -> Any:
    gone, kept = np.empty_like(cells), np.empty_like(cells)
    gone_count, kept_count, pending = 0, 0, 0
    for k in range(cells.shape[0]):
        row, column = cells[k, 0], cells[k, 1]
        if not window.first_row <= row < window.last_row:
            continue
        if not window.first_column <= column < window.last_column:
            continue
        x, y = middles[k, 0], middles[k, 1]
        if has_echo(x, y, beams):
            if passes[row, column]:  # writing may occupy memory
                passes[row, column], refuted[row, column] = 0, 0
            continue
        possible = possible_directions(x, y, edge_m, beams)
        if possible != ALL_DIRECTIONS:
            refuted[row, column] |= ~possible
            passes[row, column] = min(passes[row, column], 254) + 1
            if passes[row, column] >= _TIMES and refuted[row, column] == ALL_DIRECTIONS:
                passes[row, column], refuted[row, column] = 0, 0
                gone[gone_count, 0], gone[gone_count, 1] = row, column
                gone_count += 1
                continue
            pending += 1
        kept[kept_count, 0], kept[kept_count, 1] = row, column
        kept_count += 1
    return gone[:gone_count].copy(), kept[:kept_count].copy(), pending
