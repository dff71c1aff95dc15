"""Edge costs of grid searches, and grids with a lethal rim.

Costs are fixed-point integers: one straight step over a free cell is ``STRAIGHT``
units, a diagonal one ``DIAGONAL`` (√2 to four digits), so that sums are exact and
independent of order, and an open list can be an array of buckets.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.navigation.grids import sparse_zeros

STRAIGHT = 10_000
DIAGONAL = 14_142
LETHAL = 255
"""Cell cost that no path enters."""
MAX_PASSABLE_COST = 252
"""Highest passable cell cost, as in Nav2's costmaps."""

Cell = tuple[int, int]
"""(row, column)."""


@dataclass(frozen=True)
class EdgeTable:
    """Cost of entering a cell by the cell's cost (0-255); 0 means closed.

    ``straight[c] = STRAIGHT * (1 + weight * c / 252)``, likewise ``diagonal``.
    """

    weight: float = 0.0

    def __post_init__(self) -> None:
        if not 0 <= self.weight <= 1000:
            raise InvalidValueError(f"edge weight {self.weight!r}: expected 0 to 1000")

    @cached_property
    def straight(self) -> NDArray[np.int32]:
        return self._table(STRAIGHT)

    @cached_property
    def diagonal(self) -> NDArray[np.int32]:
        return self._table(DIAGONAL)

    @property
    def longest(self) -> int:
        """Cost of the most expensive single step, in units."""
        return int(self.diagonal.max())

    def _table(self, unit: int) -> NDArray[np.int32]:
        cost = np.arange(256)
        table = np.rint(unit * (1 + self.weight * cost / MAX_PASSABLE_COST)).astype(
            np.int32
        )
        table[LETHAL:] = 0
        return table


class SearchGrid(NamedTuple):
    """What a search kernel reads: a flat grid with a lethal rim, and its edge costs.

    Attributes:
        cost: ((H + 2) · (W + 2),) cell costs, row by row.
        stride: W + 2.
        straight, diagonal: (256,) cost of entering a cell, 0 if closed.
    """

    cost: NDArray[np.uint8]
    stride: int
    straight: NDArray[np.int32]
    diagonal: NDArray[np.int32]

    @classmethod
    def of(
        cls,
        cost: NDArray[np.uint8],
        table: EdgeTable,
        rimmed: NDArray[np.uint8] | None = None,
    ) -> "SearchGrid":
        """Return the grid of costs (H, W).

        ``rimmed`` (H + 2, W + 2) is overwritten, unless ``cost`` has a rim already.
        """
        rimmed = with_rim(cost, rimmed)
        return cls(rimmed.reshape(-1), rimmed.shape[1], table.straight, table.diagonal)

    def index_of(self, cell: Cell) -> int:
        """Return the flat index of an unrimmed (row, column)."""
        return (cell[0] + 1) * self.stride + cell[1] + 1

    def is_open(self, cell: Cell) -> bool:
        return bool(self.straight[self.cost[self.index_of(cell)]])


def rimmed_costs(shape: tuple[int, ...], value: int) -> NDArray[np.uint8]:
    """Return (H, W) cells of one cost, with a lethal rim around them in memory.

    A search reads them without the copy that costs as much as a short search.
    """
    height, width = shape
    rimmed = sparse_zeros((height + 2, width + 2), np.uint8)
    rimmed[...] = value
    return _inside_rim(rimmed)


def copy_costs(cost: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return a copy of costs (H, W) with a lethal rim around them in memory."""
    rimmed = sparse_zeros((cost.shape[0] + 2, cost.shape[1] + 2), np.uint8)
    rimmed[1:-1, 1:-1] = cost
    return _inside_rim(rimmed)


def _inside_rim(rimmed: NDArray[np.uint8]) -> NDArray[np.uint8]:
    rimmed[0] = rimmed[-1] = rimmed[:, 0] = rimmed[:, -1] = LETHAL
    return rimmed[1:-1, 1:-1]


def rim_of(cost: NDArray[np.uint8]) -> NDArray[np.uint8] | None:
    """Return the array (H + 2, W + 2) with a lethal rim that ``cost`` is a part of.

    None without such an array.
    """
    whole = cost.base
    if not isinstance(whole, np.ndarray) or not whole.flags.c_contiguous:
        return None
    if whole.dtype != np.uint8 or whole.ndim != 2 or min(whole.shape) < 2:
        return None
    inside = whole[1:-1, 1:-1]
    rim = (whole[0], whole[-1], whole[:, 0], whole[:, -1])
    if inside.__array_interface__ != cost.__array_interface__:
        return None
    return whole if all((side == LETHAL).all() for side in rim) else None


def with_rim(
    cost: NDArray[np.uint8], rimmed: NDArray[np.uint8] | None = None
) -> NDArray[np.uint8]:
    """Return cost (H, W) as (H + 2, W + 2) with a lethal rim: no bounds checks needed.

    Args:
        cost: costs of the cells; if they have a rim (:func:`rim_of`), it is returned.
        rimmed: the array to use otherwise, if it has that shape.

    Raises:
        InvalidValueError: not 2-D uint8, or more than 32000 cells a side.
    """
    if cost.ndim != 2 or cost.dtype != np.uint8:
        raise InvalidValueError(
            f"cost grid of shape {cost.shape}, {cost.dtype}: expected 2-D uint8"
        )
    height, width = cost.shape
    if max(height, width) > 32_000:
        raise InvalidValueError(
            f"cost grid of {height} x {width} cells: must be at most 32000 a side"
        )
    present = rim_of(cost)
    if present is not None:
        return present
    if rimmed is None or rimmed.shape != (height + 2, width + 2):
        rimmed = np.empty((height + 2, width + 2), np.uint8)
    _inside_rim(rimmed)[:] = cost
    return rimmed


def require_inside(cell: Cell, shape: tuple[int, ...], what: str) -> None:
    """Raise InvalidValueError unless ``cell`` lies in a grid of ``shape``."""
    if not (0 <= cell[0] < shape[0] and 0 <= cell[1] < shape[1]):
        raise InvalidValueError(
            f"{what} cell {cell}: outside the grid of {shape[0]} x {shape[1]} cells"
        )


def steps_cost(
    cells: NDArray[np.int64], cost: NDArray[np.uint8], table: EdgeTable
) -> int:
    """Return the cost in units of a chain (N, 2) of neighbouring cells."""
    entered = cost[cells[1:, 0], cells[1:, 1]]
    diagonal = np.abs(np.diff(cells, axis=0)).sum(axis=1) == 2
    each = np.where(diagonal, table.diagonal[entered], table.straight[entered])
    return int(each.sum())
