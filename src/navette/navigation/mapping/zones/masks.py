"""Filter masks: values of zones on the map, scaled as Nav2's costmap filters do."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import FREE, LETHAL, GridSpec


@dataclass(frozen=True, eq=False)
class FilterMask:
    """A mask; a speed limit is ``base + multiplier · cell``.

    Attributes:
        cells: (H, W) 0 … 100; -1 has no value.
        spec: their geometry in the map frame.
        base, multiplier: of the filter's info.
    """

    cells: NDArray[np.int8]
    spec: GridSpec
    base: float = 0.0
    multiplier: float = 1.0

    def cell_at(self, x: float, y: float) -> int:
        """Return the cell at a point of the map (m); -1 outside the mask."""
        row, column = self.spec.cell_of(x, y)
        inside = self.spec.contains(row, column)
        return int(self.cells[row, column]) if inside else -1

    def value_at(self, x: float, y: float) -> float | None:
        """Return the value at a point of the map (m); None outside, or without one."""
        cell = self.cell_at(x, y)
        return None if cell < 0 else self.base + self.multiplier * cell

    def keep_out(self, lethal_value: int) -> NDArray[np.int8]:
        """Return cells (H, W): 100 from a value of the mask on, else 0.

        Base and multiplier do not count, as in Nav2's KeepoutFilter.
        """
        return np.where(self.cells >= lethal_value, np.int8(LETHAL), np.int8(FREE))
