"""A grid laid over a map: the newer overwrites, or the larger value wins."""

import math
from typing import Any, Literal

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.grids.alignment import (
    grid_relation,
    has_lethal,
    pull_row,
    pushes_lethal,
    related_cell,
    row_range,
)
from navette.grids.cells import LETHAL
from navette.grids.checks import grid_array, output_array
from navette.grids.spec import GridSpec

MergeMode = Literal["overwrite", "max"]


def merge(
    target: NDArray[np.int8],
    target_spec: GridSpec,
    source: NDArray[np.int8],
    source_spec: GridSpec,
    mode: MergeMode = "overwrite",
    *,
    sensor: tuple[float, float] = (0.0, 0.0),
    erase_within: float = math.inf,
) -> None:
    """Lay ``source`` over ``target``; unknown source cells leave the target alone.

    Args:
        target: (H, W) -1 unknown, 0 free … 100 lethal; changed in place.
        target_spec: where it lies.
        source: (h, w) of the same meaning.
        source_spec: where it lies, in the target's frame, rotated as may be.
        mode: ``overwrite`` = the source's known cells replace the target's;
            ``max`` = the larger of both.
        sensor: (x, y) that the source was seen from, in the target's frame, m.
        erase_within: distance from there, m, from which on a lethal target cell is
            not overwritten by a lower one. Far away neighbouring beams pass a post
            on both sides: they free its cell without having seen it.
    """
    if mode not in ("overwrite", "max"):
        raise InvalidValueError(f"merge mode {mode!r}; wanted overwrite or max")
    grid = output_array("target", target, np.int8, target_spec.shape)
    cells = grid_array("source", source, np.int8, source_spec)
    push = pushes_lethal(target_spec, source_spec)
    _merge_kernel(
        grid,
        cells,
        grid_relation(source_spec, target_spec),
        grid_relation(target_spec, source_spec),
        np.int8(LETHAL - 1 if push else LETHAL),
        mode == "max",
        _to_cells(target_spec, sensor),
        float(erase_within) / target_spec.resolution,
    )


def _to_cells(spec: GridSpec, point: tuple[float, float]) -> tuple[float, float]:
    """(u, v): columns and rows from the grid's corner to a point of its frame."""
    corner_T_point = spec.origin.inverse() @ Pose2(*point, 0.0)
    return corner_T_point.x / spec.resolution, corner_T_point.y / spec.resolution


@njit(cache=True)
def _merge_kernel(
    target: Any,
    source: Any,
    relation: Any,
    inverse: Any,
    lethal_as: Any,
    larger: bool,
    sensor: Any,
    erase_within: float,
) -> None:
    height, width = source.shape
    pulled = np.empty(target.shape[1], np.int8)
    first_row, last_row = row_range(inverse, width, height, target.shape[0])
    for r in range(first_row, last_row):
        first, last = pull_row(source, relation, r, lethal_as, pulled)
        if larger:
            _max_row(target[r, first:last], pulled[first:last])
        else:
            near, far = _chord(
                r + 0.5 - sensor[1], sensor[0], erase_within, first, last
            )
            _keep_lethal_row(target[r, first:near], pulled[first:near])
            _overwrite_row(target[r, near:far], pulled[near:far])
            _keep_lethal_row(target[r, far:last], pulled[far:last])
    if lethal_as < LETHAL:
        for r in range(height):
            if has_lethal(source[r]):
                _push_lethal(target, source[r], inverse, r)


@njit(cache=True)
def _push_lethal(target: Any, source: Any, inverse: Any, r: int) -> None:
    """Set the target cells that hold the centres of row ``r``'s lethal cells."""
    for c in range(source.size):
        if source[c] >= LETHAL:
            row, column = related_cell(inverse, r, c)
            if 0 <= row < target.shape[0] and 0 <= column < target.shape[1]:
                target[row, column] = LETHAL


@njit(cache=True)
def _overwrite_row(target: Any, pulled: Any) -> None:
    for c in range(target.size):
        target[c] = pulled[c] if pulled[c] >= 0 else target[c]


@njit(cache=True)
def _keep_lethal_row(target: Any, pulled: Any) -> None:
    lethal = np.int8(LETHAL)
    for c in range(target.size):
        known = pulled[c] if pulled[c] >= 0 else target[c]
        target[c] = known if target[c] < lethal else target[c]


@njit(cache=True)
def _chord(
    v: float, center: float, radius: float, first: int, last: int
) -> tuple[int, int]:
    """Columns within [first, last) whose centres lie in a disc, ``v`` rows off it."""
    if radius == np.inf:
        return first, last
    if abs(v) >= radius:
        return last, last
    half = math.sqrt(radius * radius - v * v)
    near = math.ceil(center - half - 0.5)
    far = math.floor(center + half - 0.5) + 1
    near = min(max(near, first), last)
    return near, max(min(far, last), near)


@njit(cache=True)
def _max_row(target: Any, pulled: Any) -> None:
    for c in range(target.size):
        target[c] = pulled[c] if pulled[c] > target[c] else target[c]
