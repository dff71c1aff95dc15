"""Accumulation of occupancy evidence as log odds."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.navigation.grids.alignment import (
    Alignment,
    align,
    cell_at,
    has_lethal,
    pull_row,
    row_range,
)
from navette.navigation.grids.checks import grid_array, output_array
from navette.navigation.grids.spec import FREE, LETHAL, UNKNOWN, Cells, GridSpec

LogOdds = NDArray[np.float32]


class _Weights(NamedTuple):
    hit: np.float32
    miss: np.float32
    limit: np.float32


def accumulate(
    log_odds: LogOdds,
    target_spec: GridSpec,
    source: Cells,
    source_spec: GridSpec,
    *,
    hit: float,
    miss: float,
    limit: float,
    lethal_cells: NDArray[np.int64] | None = None,
) -> None:
    """Add the evidence of one grid to a field of log odds of occupancy.

    A lethal source cell adds ``hit``, another known cell ``miss`` (Moravec and Elfes
    1985, in the log form of Thrun, Burgard and Fox 2005, table 9.1).

    Args:
        log_odds: (H, W) float32, NaN = never observed; changed in place.
        target_spec: its geometry.
        source: (h, w) -1 unknown, 0 free … 100 lethal.
        source_spec: its geometry in the target's frame.
        hit: log odds added, > 0.
        miss: log odds added, < 0.
        limit: the field is clipped to ±limit, so that it can follow changes.
        lethal_cells: (M, 2) the cells that are hit; see
            :func:`navette.navigation.grids.merge`.

    Raises:
        InvalidValueError: weights of the wrong sign, or arrays that do not match
            their specs.
    """
    if not (hit > 0.0 > miss and limit > 0.0):
        raise InvalidValueError(
            f"hit {hit}, miss {miss}, limit {limit}: must be hit > 0 > miss, limit > 0"
        )
    field = output_array("log_odds", log_odds, np.float32, target_spec.shape)
    cells = grid_array("source", source, np.int8, source_spec)
    weights = _Weights(np.float32(hit), np.float32(miss), np.float32(limit))
    alignment = align(target_spec, source_spec)
    _accumulate_kernel(field, cells, alignment, weights, lethal_cells is None)
    if lethal_cells is not None:
        hits = np.ascontiguousarray(lethal_cells)
        _add_hits(field, cells, alignment, weights, hits)


@kernel
def _accumulate_kernel(
    field: LogOdds,
    source: Cells,
    alignment: Alignment,
    weights: _Weights,
    pushes: bool,
) -> None:
    apart = alignment.pushes_lethal or not pushes
    lethal_as = np.int8(UNKNOWN) if apart else np.int8(LETHAL)
    pulled = np.empty(field.shape[1], np.int8)
    first_row, last_row = row_range(source, alignment, field.shape[0])
    for r in range(first_row, last_row):
        first, last = pull_row(source, alignment, r, lethal_as, pulled)
        for c in range(first, last):
            if pulled[c] >= 0:
                step = weights.hit if pulled[c] >= LETHAL else weights.miss
                field[r, c] = _added(field[r, c], step, weights.limit)
    if alignment.pushes_lethal and pushes:
        for r in range(source.shape[0]):
            if has_lethal(source[r]):
                _push_hits(field, source, alignment, weights, r)


@kernel
def _push_hits(
    field: LogOdds, source: Cells, alignment: Alignment, weights: _Weights, r: int
) -> None:
    """Add a hit to the target cells that contain row ``r``'s lethal cell centres."""
    for c in range(source.shape[1]):
        if source[r, c] >= LETHAL:
            row, column = cell_at(alignment.target_T_source, r, c)
            if 0 <= row < field.shape[0] and 0 <= column < field.shape[1]:
                _add_hit(field, source, alignment, weights, row, column)


@kernel
def _add_hits(
    field: LogOdds,
    source: Cells,
    alignment: Alignment,
    weights: _Weights,
    cells: NDArray[np.int64],
) -> None:
    for k in range(cells.shape[0]):
        _add_hit(field, source, alignment, weights, cells[k, 0], cells[k, 1])


@kernel
def _add_hit(
    field: LogOdds,
    source: Cells,
    alignment: Alignment,
    weights: _Weights,
    row: int,
    column: int,
) -> None:
    """Add a hit to a target cell.

    Where the cell's own centre lies in a free source cell, its miss is taken back:
    within one grid a hit outweighs a miss.
    """
    at_row, at_column = cell_at(alignment.source_T_target, row, column)
    missed = _is_free(source, at_row, at_column)
    step = weights.hit - weights.miss if missed else weights.hit
    field[row, column] = _added(field[row, column], step, weights.limit)


@kernel
def _is_free(source: Cells, row: int, column: int) -> bool:
    height, width = source.shape
    if not (0 <= row < height and 0 <= column < width):
        return False
    return bool(FREE <= source[row, column] < LETHAL)


@kernel
def _added(current: Any, step: Any, limit: Any) -> Any:
    total = step if math.isnan(current) else current + step
    return min(max(total, -limit), limit)
