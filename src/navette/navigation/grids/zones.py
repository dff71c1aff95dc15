"""Zones of a mask on another grid."""

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids.spec import LETHAL, GridSpec


class KeepOutZones:
    """Cells that the body must not touch, whatever sensors see there.

    Args:
        cells: (H, W), 100 = keep out.
        spec: geometry of the cells in the map frame.
    """

    def __init__(self, cells: NDArray[np.int8], spec: GridSpec) -> None:
        self.cells, self.spec = cells, spec
        self._on: tuple[GridSpec, NDArray[np.bool_]] | None = None

    def on(self, spec: GridSpec) -> NDArray[np.bool_]:
        """Return (H, W) whether the cells of a grid lie in a zone."""
        if self._on is None or self._on[0] != spec:
            self._on = spec, self._looked_up(spec)
        return self._on[1]

    def marked(self, occupancy: NDArray[np.int8], spec: GridSpec) -> NDArray[np.int8]:
        """Return a copy of a map (H, W) whose cells in zones are lethal."""
        marked = occupancy.copy()
        marked[self.on(spec)] = LETHAL
        return marked

    def _looked_up(self, spec: GridSpec) -> NDArray[np.bool_]:
        found = np.zeros(spec.shape, np.bool_)
        columns = (np.arange(spec.width) + 0.5) * spec.resolution
        map_T_grid, mask_T_map = spec.origin, self.spec.origin.inverse()
        for row in range(spec.height):
            v = np.full(spec.width, (row + 0.5) * spec.resolution)
            on_map = map_T_grid.apply(np.column_stack([columns, v]))
            uv = np.floor(mask_T_map.apply(on_map) / self.spec.resolution)
            column, line = uv.astype(np.int64).T
            inside = (column >= 0) & (column < self.spec.width)
            inside &= (line >= 0) & (line < self.spec.height)
            found[row, inside] = self.cells[line[inside], column[inside]] >= LETHAL
        return found
