"""Keep-out zones of a mask on another grid, and a map that contains them."""

import math
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids.received_map import ReceivedMap
from navette.navigation.grids.shared_cells import SharedCells
from navette.navigation.grids.spec import LETHAL, Cells, GridFrame, GridSpec, grid_frame
from navette.navigation.grids.windows import CellWindow


class KeepOutZones:
    """Cells that the body must not touch, whatever sensors see there.

    Args:
        cells: (H, W), 100 = keep out.
        spec: geometry of the cells in the map frame.
    """

    def __init__(self, cells: Cells, spec: GridSpec) -> None:
        self._cells, self._spec = cells, spec
        self._corners = _corners(cells, spec)

    def mark(self, occupancy: Cells, spec: GridSpec, window: CellWindow) -> None:
        """Make cells of a map (H, W) lethal that touch a zone and lie in a window."""
        if not len(self._corners):
            return
        near = CellWindow.around(spec, self._corners, margin=1)
        mask_T_grid = self._spec.origin.inverse() @ spec.origin
        grid = GridSpec(spec.resolution, spec.width, spec.height, mask_T_grid)
        edge_m = self._spec.resolution
        window = window.intersection(near)
        _mark(occupancy, grid_frame(grid), self._cells, edge_m, window)


def _corners(cells: Cells, spec: GridSpec) -> NDArray[np.float64]:
    """Return (4, 2) corners of a rectangle in the map (m) that contains all zones."""
    is_lethal = cells >= LETHAL
    rows = np.flatnonzero(is_lethal.any(axis=1))
    columns = np.flatnonzero(is_lethal.any(axis=0))
    if not len(rows):
        return np.empty((0, 2))
    edges = product((columns[0], columns[-1] + 1), (rows[0], rows[-1] + 1))
    return spec.origin.apply(np.array(list(edges)) * spec.resolution)


class ZonedMap:
    """A received map with keep-out zones, updated where the map changed."""

    def __init__(self, zones: KeepOutZones) -> None:
        self._zones = zones
        self._received: ReceivedMap | None = None
        self._map = SharedCells(np.empty((0, 0), np.int8))

    def share(self) -> None:
        """Leave the array to others that still use it."""
        self._map.share()

    def update(self, received: ReceivedMap, changed: CellWindow) -> Cells:
        """Return the cells (H, W) of a map and of the zones.

        Args:
            received: the map.
            changed: where it differs from the last call, if it is the same map.
        """
        if received is not self._received:
            self._received = received
            self._map.replace(received.cells)
            changed = CellWindow.whole(received.cells.shape)
        elif changed.is_empty:
            return self._map.cells
        cells = self._map.writable()
        cells[changed.slices] = received.cells[changed.slices]
        self._zones.mark(cells, received.spec, changed)
        return cells


@kernel(allocates=False)
def _mark(
    occupancy: Any, frame: GridFrame, mask: Any, edge_m: float, window: CellWindow
) -> None:
    """Mark cells that are in zones; ``frame`` is the grid in the mask's.

    A cell is tested at points no further apart than the mask's cells: a line of these
    closes a coarser grid too.
    """
    parts = max(1, math.ceil(frame.resolution / edge_m - 1e-6))
    for row in range(window.first_row, window.last_row):
        for column in range(window.first_column, window.last_column):
            for part in range(parts * parts):
                x = (column + (part % parts + 0.5) / parts) * frame.resolution
                y = (row + (part // parts + 0.5) / parts) * frame.resolution
                u = (frame.x + frame.cos * x - frame.sin * y) / edge_m
                v = (frame.y + frame.sin * x + frame.cos * y) / edge_m
                is_inside = 0.0 <= u < mask.shape[1] and 0.0 <= v < mask.shape[0]
                if is_inside and mask[int(v), int(u)] >= LETHAL:
                    occupancy[row, column] = LETHAL
                    break
