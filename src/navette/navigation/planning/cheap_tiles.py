"""Where in a grid cells cost less than a floor: a tighter heuristic for searches.

The straight line to the goal at the cost of free cells is a loose bound where most of
the map is unknown and costs more. Of a path between two cells, at least the parts from
each to the nearest cheaper cell cost the floor. The distances to cheaper cells are
those of square tiles, which are fewer by a factor of 64, and rounded down.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import CellWindow
from navette.navigation.planning.traversal import DIAGONAL, STRAIGHT, EdgeTable

TILE = 8
"""Edge of a tile, cells."""
_FAR = 1 << 27  # units: farther than any tile of a map is from another


class CheapTiles:
    """Tiles with a cell below the floor, kept up to date where costs change.

    Args:
        cost: (H, W) cell costs.
        floor: cost of a cell from which it is not cheap.
        window: no cell outside of it is cheap.
    """

    def __init__(self, cost: NDArray[np.uint8], floor: int, window: CellWindow) -> None:
        self._floor = floor
        shape = tuple(-(-size // TILE) for size in cost.shape)
        self._cheap = np.zeros(shape, np.bool_)
        self._distances: NDArray[np.int32] | None = None
        self.update(cost, window)

    def update(self, cost: NDArray[np.uint8], window: CellWindow) -> None:
        """Mark the tiles of a window of the grid (H, W)."""
        if _mark_cheap(cost, np.uint8(self._floor), window, self._cheap):
            self._distances = None

    def distances(self) -> NDArray[np.int32]:
        """Return (h, w) a lower bound on the octile distance to a cheap cell, units."""
        if self._distances is None:
            height, width = self._cheap.shape
            away = np.full((height + 2, width + 2), _FAR, np.int32)
            self._distances = np.empty((height, width), np.int32)
            _measure(self._cheap, away, self._distances)
        return self._distances

    def excess(self, table: EdgeTable) -> int:
        """Return what a unit of distance costs more elsewhere, in 1/10000."""
        straight = int(table.straight[self._floor]) / STRAIGHT
        diagonal = int(table.diagonal[self._floor]) / DIAGONAL
        return max(0, int((min(straight, diagonal) - 1) * 10_000))

    def copy(self) -> "CheapTiles":
        """Return tiles that change independently."""
        other: CheapTiles = object.__new__(CheapTiles)
        other._floor, other._cheap = self._floor, self._cheap.copy()
        other._distances = None
        return other


@kernel(allocates=False)
def _mark_cheap(cost: Any, floor: Any, window: Any, cheap: Any) -> bool:
    """Mark the tiles of a window; return whether any mark changed."""
    height, width = cost.shape
    changed = False
    for i in range(window.first_row // TILE, (window.last_row - 1) // TILE + 1):
        for j in range(
            window.first_column // TILE, (window.last_column - 1) // TILE + 1
        ):
            found = False
            for row in range(i * TILE, min(height, (i + 1) * TILE)):
                line = cost[row, j * TILE : min(width, (j + 1) * TILE)]
                for k in range(line.size):
                    found |= line[k] < floor
                if found:
                    break
            changed |= found != cheap[i, j]
            cheap[i, j] = found
    return changed


@kernel(allocates=False)
def _measure(cheap: Any, away: Any, distances: Any) -> None:
    """Write the lower bounds on the distances of cells in tiles (h, w), units.

    ``away``: (h + 2, w + 2) far; gets the octile distances between tiles.
    """
    height, width = cheap.shape
    for i in range(height):
        line = away[i + 1]
        for j in range(width):
            line[j + 1] = 0 if cheap[i, j] else line[j + 1]
        _lower(line, away[i], range(1, width + 1))
    for i in range(height - 1, -1, -1):
        line, bound = away[i + 1], distances[i]
        _lower(line, away[i + 2], range(width, 0, -1))
        for j in range(width):
            # Cells of two tiles are nearer than the tiles by up to a tile each way.
            bound[j] = max(line[j + 1] - DIAGONAL, 0) * TILE


@kernel(allocates=False)
def _lower(line: Any, before: Any, columns: Any) -> None:
    """Lower a row to the distances by way of the one before, and along it."""
    for j in range(1, line.size - 1):  # vectorised, as the running minimum is not
        diagonal = min(before[j - 1], before[j + 1]) + DIAGONAL
        line[j] = min(line[j], before[j] + STRAIGHT, diagonal)
    least = np.int32(_FAR)
    for j in columns:
        least = min(np.int32(least + STRAIGHT), line[j])
        line[j] = least
