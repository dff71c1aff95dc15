"""The map as the planner receives it: whole, and then the parts that changed."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import NO_CELLS, CellWindow, GridSpec, copied
from navette.navigation.planning.planning_grid import NO_HITS

Cells = NDArray[np.int8]


class NewMap(NamedTuple):
    """A map that replaces the one before."""

    cells: Cells
    """(H, W) −1 unknown, 0 free … 100 occupied; may be the array of the last map."""

    spec: GridSpec
    hits: NDArray[np.float64] = NO_HITS
    """(N, 2), map frame, m: where beams ended within the lethal cells."""

    changed: CellWindow | None = None
    """The cells that differ from the last map; None: not known."""


class MapPart(NamedTuple):
    """New cells (h, w) of a window of the map."""

    cells: Cells
    window: CellWindow


class ReceivedMap:
    """The newest map; its array is copied before the first part changes it.

    Attributes:
        cells: (H, W) −1 unknown, 0 free … 100 occupied.
        spec: their geometry.
    """

    def __init__(self, cells: Cells, spec: GridSpec) -> None:
        self.cells, self.spec = cells, spec
        self._is_own = False

    def share(self) -> None:
        """Leave the array to others that still use it."""
        self._is_own = False

    def update(self, part: MapPart | None) -> CellWindow:
        """Change a part; return what has changed."""
        if part is None:
            return NO_CELLS
        if not self._is_own:
            self.cells, self._is_own = copied(self.cells), True
        self.cells[part.window.slices] = part.cells
        return part.window
