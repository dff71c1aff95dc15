"""Regions of a grid that requests name."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids.spec import GridSpec, grid_frame


class SquareRegion(NamedTuple):
    """A square (centre and edge in m, the grid's frame), or all but the square."""

    x: float
    y: float
    edge: float
    is_outside: bool = False

    def mask(self, spec: GridSpec) -> NDArray[np.bool_]:
        """Return (H, W) which cells of a grid have their centres in the region."""
        frame = grid_frame(spec)
        u = (np.arange(spec.width) + 0.5) * spec.resolution
        v = ((np.arange(spec.height) + 0.5) * spec.resolution)[:, None]
        x = frame.x + frame.cos * u - frame.sin * v
        y = frame.y + frame.sin * u + frame.cos * v
        near = self.edge / 2
        inside = (np.abs(x - self.x) <= near) & (np.abs(y - self.y) <= near)
        return np.asarray(inside != self.is_outside)
