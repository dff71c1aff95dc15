"""The points of a map's lethal cells, found again only where the map has changed."""

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import (
    CellWindow,
    GridSpec,
    MarkedCells,
    marked_cells,
)

_NONE = MarkedCells(
    np.empty((0, 2), np.int64),
    np.empty((0, 2)),
    np.empty(0, np.int64),
    np.empty((0, 2)),
)


class MarkedPoints:
    """The lethal cells of a map with marked points, row by row."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Drop all points: the map has another extent, or other marks."""
        self._marked = _NONE
        self._stale: CellWindow | None = None  # None: everything

    def grow(self, rows_before: int, columns_before: int) -> None:
        """Follow a map that has got cells before its first, and more elsewhere."""
        shift = np.array((rows_before, columns_before))
        self._marked = self._marked._replace(cells=self._marked.cells + shift)
        if self._stale is not None:
            self._stale = self._stale.shifted(rows_before, columns_before)

    def drop(self, window: CellWindow) -> None:
        """Drop the points of a part of the map that has changed."""
        if self._stale is not None:
            self._stale = self._stale.union(window)

    def update(
        self, masks: NDArray[np.uint64], spec: GridSpec, cells: NDArray[np.int8]
    ) -> MarkedCells:
        """Return the marked cells of the map as it is now."""
        whole = CellWindow.whole(cells.shape)
        stale = whole if self._stale is None else self._stale
        if not stale.is_empty:
            first, last = stale.first_row, stale.last_row
            rows = CellWindow(first, last, 0, cells.shape[1])
            self._replace_rows(rows, marked_cells(masks, spec, cells, rows))
            self._stale = CellWindow(first, first, 0, 0)
        return self._marked

    def _replace_rows(self, rows: CellWindow, new: MarkedCells) -> None:
        old = self._marked
        before, after = np.searchsorted(
            old.cells[:, 0], (rows.first_row, rows.last_row)
        )
        first, last = old.counts[:before].sum(), old.counts[:after].sum()
        starts = (before, before, before, first)
        ends = (after, after, after, last)
        self._marked = MarkedCells(
            *(
                np.concatenate([known[:start], found, known[end:]])
                for known, found, start, end in zip(old, new, starts, ends, strict=True)
            )
        )
