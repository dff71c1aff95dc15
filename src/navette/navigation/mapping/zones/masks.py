"""Filter masks: values of zones on the map, scaled as Nav2's costmap filters do."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import FREE, LETHAL, GridSpec


@dataclass(frozen=True, eq=False)
class FilterMask:
    """A mask; the value of a cell is ``base + multiplier · cell``.

    Attributes:
        cells: (H, W) 0 … 100; -1 has no value.
        spec: their geometry in the map frame.
        base, multiplier: of the filter's info.
    """

    cells: NDArray[np.int8]
    spec: GridSpec
    base: float = 0.0
    multiplier: float = 1.0

    def value_at(self, x: float, y: float) -> float | None:
        """Return the value at a point of the map (m); None outside, or without one."""
        row, column = self.spec.cell_of(x, y)
        if not self.spec.contains(row, column) or self.cells[row, column] < 0:
            return None
        return self.base + self.multiplier * float(self.cells[row, column])

    def keep_out(self, lethal_value: int) -> NDArray[np.int8]:
        """Return cells (H, W): 100 where the value is that of a zone, else 0."""
        values = self.base + self.multiplier * self.cells.astype(np.float64)
        zones = (self.cells >= 0) & (values >= lethal_value)
        return np.where(zones, LETHAL, FREE).astype(np.int8)
