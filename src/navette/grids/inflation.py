"""Inflation: cost that falls with the distance to the nearest lethal cell."""

import math
from typing import Any, Literal

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.grids.cells import FREE, LETHAL, UNKNOWN
from navette.grids.checks import at_least, kernel_array
from navette.grids.distance import Scratch, column_distances, row_squares

InflationMethod = Literal["linear", "exponential"]


def cost_table(
    method: InflationMethod,
    *,
    inflation_radius: float,
    resolution: float,
    max_cost: int = LETHAL,
    decay: float = 3.0,
) -> NDArray[np.int8]:
    """Cost by squared distance in cells, for :func:`inflate`.

    ``linear``: max_cost · (1 − d / inflation_radius);
    ``exponential``: max_cost · exp(−decay · d), cut off at the radius; both rounded.
    Only d = 0 may give :data:`LETHAL`: a cell beside an obstacle is at most one
    less, so that lethal cells can be told from dear ones.

    Args:
        method: the falling function.
        inflation_radius: d from which nothing is raised, m.
        resolution: edge of a cell, m.
        max_cost: cost towards d = 0, at most :data:`LETHAL`.
        decay: of the exponential, 1/m.

    Returns:
        ((radius + 1)² + 1,) int8 where radius = floor(inflation_radius / resolution)
        cells; -1 = leaves a cell as it is.
    """
    at_least("inflation_radius", inflation_radius, 0.0)
    at_least("resolution", resolution, 1e-9)
    at_least("decay", decay, 0.0)
    if not 0 <= max_cost <= LETHAL:
        raise InvalidValueError(f"max_cost: {max_cost}, wanted 0 to {LETHAL}")
    # A radius of a whole number of cells must not lose one to rounding.
    radius = math.floor(inflation_radius / resolution + 1e-9)
    metres = resolution * np.sqrt(np.arange((radius + 1) ** 2 + 1))
    if method == "linear":
        fall = 1.0 - metres / max(inflation_radius, resolution * 1e-6)
    elif method == "exponential":
        fall = np.exp(-decay * metres)
    else:
        raise InvalidValueError(
            f"inflation method {method!r}; wanted linear or exponential"
        )
    cost = np.rint(max_cost * fall)
    cost[(metres >= inflation_radius) | (cost <= 0)] = UNKNOWN
    cost[1:] = np.minimum(cost[1:], LETHAL - 1)
    cost[0] = LETHAL
    return cost.astype(np.int8)


def inflate(
    cost: NDArray[np.int8], table: NDArray[np.int8], *, raise_unknown: bool = True
) -> NDArray[np.int8]:
    """Raise each cell to the cost that its distance to a lethal cell gives.

    Args:
        cost: (H, W) -1 unknown, 0 free … 100 lethal; not changed.
        table: from :func:`cost_table`; its length tells the radius.
        raise_unknown: whether an unknown cell near an obstacle gets a cost too. Not
            where a map is to be kept from it: there an unknown cell says "I did not
            see", a raised one says "I saw no obstacle here".

    Returns:
        (H, W) int8, a new array.
    """
    cost = kernel_array("cost", cost, np.int8)
    table = kernel_array("table", table, np.int8, 1)
    radius = math.isqrt(table.size - 1) - 1
    if radius < 0 or table.size != (radius + 1) ** 2 + 1:
        raise InvalidValueError(
            f"table: {table.size} entries, wanted (radius + 1)² + 1; see cost_table"
        )
    scratch = Scratch(cost.shape, radius)
    if scratch.radius < radius:
        table = table[: (scratch.radius + 1) ** 2 + 1].copy()
        table[-1] = UNKNOWN  # nothing found
    lethal = (cost >= LETHAL).view(np.uint8)
    inflated = np.empty_like(cost)
    lowest = np.int8(UNKNOWN if raise_unknown else FREE)
    _inflate_kernel(
        cost,
        lethal,
        table,
        lowest,
        scratch.columns,
        scratch.padded,
        scratch.row,
        inflated,
    )
    return inflated


@njit(cache=True)
def _inflate_kernel(
    cost: Any,
    lethal: Any,
    table: Any,
    lowest: Any,
    columns: Any,
    padded: Any,
    row: Any,
    inflated: Any,
) -> None:
    radius = (padded.size - row.size) // 2
    padded[:] = padded.dtype.type((radius + 1) * (radius + 1))
    column_distances(lethal, radius, columns)
    for r in range(columns.shape[0]):
        row_squares(columns[r], radius, padded, row)
        _raise_row(cost[r], table, lowest, row, inflated[r])


@njit(cache=True)
def _raise_row(cost: Any, table: Any, lowest: Any, row: Any, inflated: Any) -> None:
    for c in range(row.size):
        raised = table[row[c]]
        now = cost[c]
        inflated[c] = raised if raised > now and now >= lowest else now
