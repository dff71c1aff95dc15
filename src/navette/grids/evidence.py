"""Evidence that adds up: log odds of a cell being occupied."""

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.grids.alignment import (
    grid_relation,
    has_lethal,
    pull_row,
    pushes_lethal,
    related_cell,
    row_range,
)
from navette.grids.cells import FREE, LETHAL, UNKNOWN
from navette.grids.checks import grid_array, output_array
from navette.grids.spec import GridSpec


def accumulate(
    log_odds: NDArray[np.float32],
    target_spec: GridSpec,
    source: NDArray[np.int8],
    source_spec: GridSpec,
    *,
    hit: float,
    miss: float,
    limit: float,
) -> None:
    """Add one grid's evidence to a field of log odds of being occupied.

    A lethal source cell adds ``hit``, any other known one ``miss`` (Moravec and
    Elfes 1985, in the log form of Thrun, Burgard and Fox 2005, table 9.1).

    Args:
        log_odds: (H, W) float32, NaN = never observed; changed in place.
        target_spec: where it lies.
        source: (h, w) -1 unknown, 0 free … 100 lethal.
        source_spec: where it lies, in the target's frame.
        hit: log odds added, > 0.
        miss: log odds added, < 0.
        limit: the field stays within ±limit, so that it can change its mind.
    """
    if not (hit > 0.0 > miss and limit > 0.0):
        raise InvalidValueError(
            f"hit {hit}, miss {miss}, limit {limit}: wanted hit > 0 > miss, limit > 0"
        )
    field = output_array("log_odds", log_odds, np.float32, target_spec.shape)
    cells = grid_array("source", source, np.int8, source_spec)
    push = pushes_lethal(target_spec, source_spec)
    _accumulate_kernel(
        field,
        cells,
        grid_relation(source_spec, target_spec),
        grid_relation(target_spec, source_spec),
        np.int8(UNKNOWN if push else LETHAL),
        np.float32(hit),
        np.float32(miss),
        np.float32(limit),
    )


@njit(cache=True)
def _accumulate_kernel(
    field: Any,
    source: Any,
    relation: Any,
    inverse: Any,
    lethal_as: Any,
    hit: Any,
    miss: Any,
    limit: Any,
) -> None:
    height, width = source.shape
    pulled = np.empty(field.shape[1], np.int8)
    first_row, last_row = row_range(inverse, width, height, field.shape[0])
    for r in range(first_row, last_row):
        first, last = pull_row(source, relation, r, lethal_as, pulled)
        for c in range(first, last):
            if pulled[c] >= 0:
                step = hit if pulled[c] >= LETHAL else miss
                field[r, c] = _added(field[r, c], step, limit)
    if lethal_as < LETHAL:
        for r in range(height):
            if has_lethal(source[r]):
                _push_hits(field, source, relation, inverse, r, hit, miss, limit)


@njit(cache=True)
def _push_hits(
    field: Any,
    source: Any,
    relation: Any,
    inverse: Any,
    r: int,
    hit: Any,
    miss: Any,
    limit: Any,
) -> None:
    """Add a hit to the target cells that hold the centres of row ``r``'s lethal cells.

    Where the target cell's own centre fell into a free neighbour, its miss is taken
    back: within one grid a hit wins.
    """
    for c in range(source.shape[1]):
        if source[r, c] >= LETHAL:
            row, column = related_cell(inverse, r, c)
            if 0 <= row < field.shape[0] and 0 <= column < field.shape[1]:
                at_row, at_column = related_cell(relation, row, column)
                missed = _is_free(source, at_row, at_column)
                step = hit - miss if missed else hit
                field[row, column] = _added(field[row, column], step, limit)


@njit(cache=True)
def _is_free(source: Any, row: int, column: int) -> bool:
    height, width = source.shape
    if not (0 <= row < height and 0 <= column < width):
        return False
    return bool(FREE <= source[row, column] < LETHAL)


@njit(cache=True)
def _added(now: Any, step: Any, limit: Any) -> Any:
    total = step if math.isnan(now) else now + step
    return min(max(total, -limit), limit)
