"""The points of a map's lethal cells, found again only where the map has changed."""

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import CellWindow, GridSpec, marked_points

_NO_POINTS = np.empty((0, 2))
_NO_ROWS = np.empty(0, np.int64)


class MarkedPoints:
    """Where beams ended within the lethal cells of a map, row by row."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """Drop all points: the map has another extent, or other marks."""
        self._points, self._rows = _NO_POINTS, _NO_ROWS
        self._stale: CellWindow | None = None  # None: everything

    def grow(self, rows_before: int) -> None:
        """Follow a map that has got rows before its first, and more elsewhere."""
        self._rows = self._rows + rows_before
        if self._stale is not None:
            self._stale = self._stale.shifted(rows_before, 0)

    def drop(self, window: CellWindow) -> None:
        """Drop the points of a part of the map that has changed."""
        if self._stale is not None:
            self._stale = self._stale.union(window)

    def points(
        self, masks: NDArray[np.uint64], spec: GridSpec, cells: NDArray[np.int8]
    ) -> NDArray[np.float64]:
        """Return the points (N, 2), m, of the map as it is now."""
        whole = CellWindow.whole(cells.shape)
        stale = whole if self._stale is None else self._stale
        first, last = stale.first_row, stale.last_row
        rows = CellWindow(first, last, 0, cells.shape[1])
        points, which, found = marked_points(masks, spec, cells, rows)
        before, after = np.searchsorted(self._rows, (first, last))
        self._points = np.concatenate(
            [self._points[:before], points, self._points[after:]]
        )
        self._rows = np.concatenate(
            [self._rows[:before], found[which, 0], self._rows[after:]]
        )
        self._stale = CellWindow(first, first, 0, 0)
        return self._points
