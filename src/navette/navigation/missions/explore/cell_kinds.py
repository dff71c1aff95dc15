"""What exploration needs of each cell of a map, updated where the map changed."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import (
    NO_CELLS,
    UNKNOWN,
    CellWindow,
    GridSpec,
    distance_field,
)
from navette.navigation.grids.spec import Cells

Kinds = NDArray[np.uint8]
CellIndices = NDArray[np.int64]
"""(N, 2) rows and columns."""

FREE = 1
OCCUPIED = 2
OPEN = 4
"""A cell of a frontier: free, beside an unknown one, not within a wall.

A wall is a line of occupied cells with gaps; behind it are cells that are known by
their inflation only.
"""
CLOSED = 8
"""Free, beside an occupied cell, and not of a frontier."""
PASSABLE = 16
"""Free, and so far from obstacles that the robot may pass."""
PLACE = 32
"""Free, and so far from obstacles that it may be a goal."""

_TILE = 512  # cells of which the distances to obstacles are computed at once


class KindDistances(NamedTuple):
    """KindDistances to the nearest obstacle, m, that decide the kind of a free cell."""

    wall: float
    passage: float
    place: float


class CellKinds:
    """Kinds of the cells of a map; a map begins with all cells unknown.

    Attributes:
        kinds: (H, W) sums of the constants of this module; 0 = unknown.
        known: window outside which all cells are unknown.
        free, occupied, closed: number of cells of these kinds.
    """

    def __init__(
        self, spec: GridSpec, distances: KindDistances, lethal_cost: int
    ) -> None:
        self.kinds: Kinds = np.zeros(spec.shape, np.uint8)
        self.known = NO_CELLS
        self.free = self.occupied = self.closed = 0
        self._resolution = spec.resolution
        self._lethal_cost = lethal_cost
        self._set_distances(distances)

    def set_distances(self, distances: KindDistances) -> None:
        """Use other distances for all cells."""
        self._set_distances(distances)
        for tile in _tiles(self.known):
            self._count(tile, -1)
            self._classify(tile)

    def update(self, cells: Cells, window: CellWindow) -> None:
        """Replace the cells (h, w) of a window."""
        changed = window.grown(self._margin, self.kinds.shape)
        for tile in _tiles(changed):
            self._count(tile, -1)
        _write(cells, self._lethal_cost, self.kinds, window)
        for tile in _tiles(changed):
            self._classify(tile)
        self.known = self.known.union(window)

    def cells_of(self, kind: int, window: CellWindow) -> CellIndices:
        """Return the cells of a kind within a window, in the order of the rows."""
        window = window.grown(0, self.kinds.shape)
        counts = np.empty(max(window.shape[0], 0), np.int64)
        found = np.empty((_count_rows(self.kinds, kind, window, counts), 2), np.int64)
        _gather(self.kinds, kind, window, counts, found)
        return found

    def _set_distances(self, distances: KindDistances) -> None:
        self._distances = distances
        self._reach_m = max(distances) + self._resolution
        self._margin = math.ceil(self._reach_m / self._resolution) + 1

    def _classify(self, window: CellWindow) -> None:
        """Find the kinds of the free cells of a window, and count them."""
        around = window.grown(self._margin, self.kinds.shape)
        occupied = self.kinds[around.slices] & np.uint8(OCCUPIED)
        away = distance_field(occupied, self._resolution, self._reach_m)
        _classify(self.kinds, window, away, around, self._distances)
        self._count(window, 1)

    def _count(self, window: CellWindow, sign: int) -> None:
        free, occupied, closed = _numbers(self.kinds, window)
        self.free += sign * free
        self.occupied += sign * occupied
        self.closed += sign * closed


def _tiles(window: CellWindow) -> list[CellWindow]:
    """Divide a window: the arrays of a whole map would need much memory."""
    top, bottom, left, right = window
    return [
        CellWindow(row, min(row + _TILE, bottom), column, min(column + _TILE, right))
        for row in range(top, bottom, _TILE)
        for column in range(left, right, _TILE)
    ]


@kernel(allocates=False)
def _write(cells: Any, lethal_cost: int, kinds: Any, window: CellWindow) -> None:
    """Write whether the cells are free or occupied."""
    for r in range(cells.shape[0]):
        row = kinds[window.first_row + r]
        for c in range(cells.shape[1]):
            cost = cells[r, c]
            kind = OCCUPIED if cost >= lethal_cost else FREE
            row[window.first_column + c] = 0 if cost == UNKNOWN else kind


@kernel(allocates=False)
def _classify(
    kinds: Any, window: CellWindow, away: Any, around: CellWindow, limits: KindDistances
) -> None:
    """Add the other kinds; ``away`` are the distances to obstacles of ``around``."""
    height, width = kinds.shape
    # Of the type of the distances that they are compared with.
    wall, passage = np.float32(limits.wall), np.float32(limits.passage)
    place = np.float32(limits.place)
    for row in range(window.first_row, window.last_row):
        for column in range(window.first_column, window.last_column):
            kind = kinds[row, column] & (FREE | OCCUPIED)
            if kind == FREE:
                metres = away[row - around.first_row, column - around.first_column]
                unknown, occupied = False, False
                for k in range(4):
                    r = row + (k == 0) - (k == 1)
                    c = column + (k == 2) - (k == 3)
                    if 0 <= r < height and 0 <= c < width:
                        beside = kinds[r, c]
                        unknown |= beside == 0
                        occupied |= (beside & OCCUPIED) != 0
                if unknown and metres > wall:
                    kind |= OPEN
                elif occupied:
                    kind |= CLOSED
                if metres >= passage:
                    kind |= PASSABLE
                if metres >= place:
                    kind |= PLACE
            kinds[row, column] = kind


@kernel(allocates=False)
def _numbers(kinds: Any, window: CellWindow) -> tuple[int, int, int]:
    """Return the number of free, occupied and closed cells."""
    free = occupied = closed = 0
    for row in range(window.first_row, window.last_row):
        line = kinds[row, window.first_column : window.last_column]
        for k in range(line.size):
            free += (line[k] & FREE) != 0
            occupied += (line[k] & OCCUPIED) != 0
            closed += (line[k] & CLOSED) != 0
    return free, occupied, closed


@kernel(allocates=False)
def _count_rows(kinds: Any, kind: int, window: CellWindow, counts: Any) -> int:
    """Write the number of cells of a kind in each row of a window; return the sum."""
    total = 0
    for r in range(counts.size):
        line = kinds[window.first_row + r, window.first_column : window.last_column]
        count = 0
        for k in range(line.size):  # vectorised
            count += (line[k] & kind) != 0
        counts[r] = count
        total += count
    return total


@kernel(allocates=False)
def _gather(kinds: Any, kind: int, window: CellWindow, counts: Any, found: Any) -> None:
    at = 0
    for r in range(counts.size):
        if counts[r] == 0:
            continue
        row = window.first_row + r
        for column in range(window.first_column, window.last_column):
            if (kinds[row, column] & kind) != 0:
                found[at, 0], found[at, 1] = row, column
                at += 1
