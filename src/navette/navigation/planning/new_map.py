"""A map for the planner, and what is new in it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import CellWindow, GridSpec
from navette.navigation.grids.spec import Cells
from navette.navigation.planning.planning_grid import NO_HITS


class NewMap(NamedTuple):
    """A map that replaces the one before."""

    cells: Cells
    """(H, W) −1 unknown, 0 free … 100 occupied; may be the array of the last map."""

    spec: GridSpec
    hits: NDArray[np.float64] = NO_HITS
    """(N, 2), map frame, m: where beams ended within the lethal cells."""

    changed: CellWindow | None = None
    """The cells that differ from the last map; None: not known."""
