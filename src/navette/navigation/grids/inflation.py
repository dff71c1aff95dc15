"""Inflation: cost that decreases with the distance to the nearest lethal cell.

Few lethal cells, as those of one scan, are stamped one by one with the costs around
them; of many the distances are computed first.
"""

import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.navigation.grids.checks import at_least, kernel_array
from navette.navigation.grids.distance import (
    Scratch,
    column_distances,
    make_scratch,
    row_squares,
)
from navette.navigation.grids.spec import FREE, LETHAL, UNKNOWN, Cells

_SPAN = 64  # columns of a stamp that are written at once

InflationMethod = Literal["linear", "exponential"]


def cost_table(
    method: InflationMethod,
    *,
    inflation_radius_m: float,
    resolution: float,
    max_cost: int = LETHAL,
    decay_per_m: float = 3.0,
) -> NDArray[np.int8]:
    """Cost by squared distance in cells, for :func:`inflate`.

    ``linear``: max_cost · (1 − d / inflation_radius_m);
    ``exponential``: max_cost · exp(−decay_per_m · d), cut off at the radius; both
    rounded. Only d = 0 gives :data:`LETHAL`: a cell beside an obstacle gets at most
    one less, so that lethal cells stay distinct.

    Args:
        method: shape of the decrease.
        inflation_radius_m: distance from which no cost is added, m.
        resolution: edge of a cell, m.
        max_cost: cost towards d = 0, at most :data:`LETHAL`.
        decay_per_m: of the exponential, 1/m.

    Returns:
        ((radius + 1)² + 1,) int8 where radius = floor(inflation_radius_m /
        resolution) cells; -1 = no cost is added.

    Raises:
        InvalidValueError: an unknown method, or a value out of range.
    """
    at_least("inflation_radius_m", inflation_radius_m, 0.0)
    at_least("resolution", resolution, 1e-9)
    at_least("decay_per_m", decay_per_m, 0.0)
    if not 0 <= max_cost <= LETHAL:
        raise InvalidValueError(f"max_cost: {max_cost}, must be 0 to {LETHAL}")
    # A radius of a whole number of cells must not lose one to rounding.
    radius = math.floor(inflation_radius_m / resolution + 1e-9)
    metres = resolution * np.sqrt(np.arange((radius + 1) ** 2 + 1))
    if method == "linear":
        share = 1.0 - metres / max(inflation_radius_m, resolution * 1e-6)
    elif method == "exponential":
        share = np.exp(-decay_per_m * metres)
    else:
        raise InvalidValueError(
            f"inflation method {method!r}; allowed: linear, exponential"
        )
    cost = np.rint(max_cost * share)
    cost[(metres >= inflation_radius_m) | (cost <= 0)] = UNKNOWN
    cost[1:] = np.minimum(cost[1:], LETHAL - 1)
    cost[0] = LETHAL
    return cost.astype(np.int8)


def inflate(
    cost: Cells, table: NDArray[np.int8], *, raise_unknown: bool = True
) -> Cells:
    """Raise each cell to the cost that belongs to its distance to a lethal cell.

    Args:
        cost: (H, W) -1 unknown, 0 free … 100 lethal; not changed.
        table: from :func:`cost_table`; its length determines the radius.
        raise_unknown: whether unknown cells near an obstacle get a cost. Costmaps
            that are merged into a map must not: a map treats an unknown cell as "not
            seen", but one with a cost as "seen, no obstacle".

    Returns:
        (H, W) int8, a new array.

    Raises:
        InvalidValueError: a wrong array, or a table of an impossible length.
    """
    cost = kernel_array("cost", cost, np.int8)
    table = kernel_array("table", table, np.int8, 1)
    radius = math.isqrt(table.size - 1) - 1
    if radius < 0 or table.size != (radius + 1) ** 2 + 1:
        raise InvalidValueError(
            f"table: {table.size} entries, must be (radius + 1)² + 1; see cost_table"
        )
    lowest = np.int8(UNKNOWN if raise_unknown else FREE)
    inflated = np.empty_like(cost)
    lethal_at = np.flatnonzero(cost >= LETHAL)
    side = 2 * radius + 1
    if lethal_at.size * side * math.ceil(side / _SPAN) < cost.size:
        _stamp_kernel(cost, lethal_at, table, radius, lowest, inflated)
        return inflated
    scratch = make_scratch(cost.shape, radius)
    if scratch.radius < radius:
        table = table[: (scratch.radius + 1) ** 2 + 1].copy()
        table[-1] = UNKNOWN  # no obstacle found
    lethal = (cost >= LETHAL).view(np.uint8)
    _inflate_kernel(cost, lethal, scratch, table, lowest, inflated)
    return inflated


@kernel
def _stamp_kernel(
    cost: Cells,
    lethal_at: NDArray[np.int64],
    table: NDArray[np.int8],
    radius: int,
    lowest: np.int8,
    inflated: Cells,
) -> None:
    """Stamp the costs around a lethal cell on each of them; the highest counts."""
    side = 2 * radius + 1
    spans = (side + _SPAN - 1) // _SPAN
    stamp = np.full((side, spans * _SPAN), np.int8(UNKNOWN))
    for i in range(side):
        for j in range(side):
            square = (i - radius) ** 2 + (j - radius) ** 2
            stamp[i, j] = table[min(square, table.size - 1)]
    height, width = cost.shape
    raised = np.full((height + 2 * radius, width + spans * _SPAN), np.int8(UNKNOWN))
    for at in lethal_at:
        _stamp(raised, stamp, at // width, at % width)
    for r in range(height):
        above = raised[r + radius, radius : radius + width]
        _raise_row(cost[r], above, lowest, inflated[r])


@kernel
def _stamp(raised: Cells, stamp: Cells, row: int, column: int) -> None:
    for first in range(0, stamp.shape[1], _SPAN):
        for i in range(stamp.shape[0]):
            for k in range(_SPAN):  # their number is known: vectorised
                at, there = np.uintp(column + first + k), np.uintp(first + k)
                before, new = raised[np.uintp(row + i), at], stamp[np.uintp(i), there]
                raised[np.uintp(row + i), at] = new if new > before else before


@kernel(allocates=False)
def _raise_row(cost: Cells, raised: Cells, lowest: np.int8, inflated: Cells) -> None:
    for c in range(cost.size):
        current = cost[c]
        is_raised = raised[c] > current and current >= lowest
        inflated[c] = raised[c] if is_raised else current


@kernel
def _inflate_kernel(
    cost: Cells,
    lethal: NDArray[np.uint8],
    scratch: Scratch,
    table: NDArray[np.int8],
    lowest: np.int8,
    inflated: Cells,
) -> None:
    column_distances(lethal, scratch)
    for r in range(cost.shape[0]):
        _look_up_row(cost[r], table, lowest, row_squares(scratch, r), inflated[r])


@kernel(allocates=False)
def _look_up_row(
    cost: Cells,
    table: NDArray[np.int8],
    lowest: np.int8,
    squares: NDArray[Any],
    inflated: Cells,
) -> None:
    for c in range(squares.size):
        raised = table[squares[c]]
        current = cost[c]
        inflated[c] = raised if raised > current and current >= lowest else current
