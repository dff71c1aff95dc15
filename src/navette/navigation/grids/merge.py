"""Merging of a grid into a map: newer cells overwrite, or the larger value wins."""

import math
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.grids.alignment import (
    Affine,
    Alignment,
    align,
    cell_at,
    has_lethal,
    pull_row,
    row_range,
)
from navette.navigation.grids.checks import grid_array, output_array
from navette.navigation.grids.spec import LETHAL, Cells, GridSpec

MergeMode = Literal["overwrite", "max"]


class _MergeRule(NamedTuple):
    """``sensor_u``, ``sensor_v`` and ``erase_within`` in cells of the target."""

    takes_max: bool
    sensor_u: float
    sensor_v: float
    erase_within: float


def merge(
    target: Cells,
    target_spec: GridSpec,
    source: Cells,
    source_spec: GridSpec,
    mode: MergeMode = "overwrite",
    *,
    sensor: tuple[float, float] = (0.0, 0.0),
    erase_within_m: float = math.inf,
    lethal_cells: NDArray[np.int64] | None = None,
) -> None:
    """Merge ``source`` into ``target``; unknown source cells change nothing.

    Args:
        target: (H, W) -1 unknown, 0 free … 100 lethal; changed in place.
        target_spec: its geometry.
        source: (h, w), same values.
        source_spec: its geometry in the target's frame, at any rotation.
        mode: ``overwrite`` = known source cells replace target cells; ``max`` = the
            larger value of both.
        sensor: (x, y) of the sensor that saw the source, in the target's frame, m.
        erase_within_m: a lethal target cell farther than this from the sensor is not
            overwritten by a lower value: at a distance, neighbouring beams pass a
            post on both sides and mark its cell free without having seen it.
        lethal_cells: (M, 2) row, column of the target's cells that contain the points
            where the beams ended. None = the cells that contain the centres of the
            source's lethal cells.

    Raises:
        InvalidValueError: an unknown mode, or arrays that do not match their specs.
    """
    if mode not in ("overwrite", "max"):
        raise InvalidValueError(f"merge mode {mode!r}; allowed: overwrite, max")
    grid = output_array("target", target, np.int8, target_spec.shape)
    cells = grid_array("source", source, np.int8, source_spec)
    corner_T_sensor = target_spec.origin.inverse() @ Pose2(*sensor, 0.0)
    rule = _MergeRule(
        mode == "max",
        corner_T_sensor.x / target_spec.resolution,
        corner_T_sensor.y / target_spec.resolution,
        float(erase_within_m) / target_spec.resolution,
    )
    alignment = align(target_spec, source_spec)
    pulled = np.empty(grid.shape[1], np.int8)
    _merge_kernel(grid, cells, alignment, rule, lethal_cells is None, pulled)
    if lethal_cells is not None:
        grid[lethal_cells[:, 0], lethal_cells[:, 1]] = LETHAL


@kernel(allocates=False)
def _merge_kernel(
    target: Cells,
    source: Cells,
    alignment: Alignment,
    rule: _MergeRule,
    pushes: bool,
    pulled: Cells,
) -> None:
    # The lethal cells follow from points, or from the source's lethal cells.
    apart = alignment.pushes_lethal or not pushes
    lethal_as = np.int8(LETHAL - 1) if apart else np.int8(LETHAL)
    first_row, last_row = row_range(source, alignment, target.shape[0])
    for r in range(first_row, last_row):
        first, last = pull_row(source, alignment, r, lethal_as, pulled)
        if rule.takes_max:
            _max_row(target[r, first:last], pulled[first:last])
        else:
            near, far = _chord(
                r + 0.5 - rule.sensor_v, rule.sensor_u, rule.erase_within, first, last
            )
            _keep_lethal_row(target[r, first:near], pulled[first:near])
            _overwrite_row(target[r, near:far], pulled[near:far])
            _keep_lethal_row(target[r, far:last], pulled[far:last])
    if alignment.pushes_lethal and pushes:
        for r in range(source.shape[0]):
            if has_lethal(source[r]):
                _push_lethal(target, source[r], alignment.target_T_source, r)


@kernel(allocates=False)
def _push_lethal(
    target: Cells, source_row: Cells, target_T_source: Affine, r: int
) -> None:
    """Set the target cells that contain the centres of row ``r``'s lethal cells."""
    for c in range(source_row.size):
        if source_row[c] >= LETHAL:
            row, column = cell_at(target_T_source, r, c)
            if 0 <= row < target.shape[0] and 0 <= column < target.shape[1]:
                target[row, column] = LETHAL


@kernel(allocates=False)
def _overwrite_row(target: Cells, pulled: Cells) -> None:
    for c in range(target.size):
        old, new = target[c], pulled[c]  # read first: only then is this vectorised
        target[c] = new if new >= 0 else old


@kernel(allocates=False)
def _keep_lethal_row(target: Cells, pulled: Cells) -> None:
    lethal = np.int8(LETHAL)
    for c in range(target.size):
        known = pulled[c] if pulled[c] >= 0 else target[c]
        target[c] = known if target[c] < lethal else target[c]


@kernel(allocates=False)
def _chord(
    v: float, center: float, radius: float, first: int, last: int
) -> tuple[int, int]:
    """Columns in [first, last) whose centres lie in a disc ``v`` rows away."""
    if radius == np.inf:
        return first, last
    if abs(v) >= radius:
        return last, last
    half = math.sqrt(radius * radius - v * v)
    near = math.ceil(center - half - 0.5)
    far = math.floor(center + half - 0.5) + 1
    near = min(max(near, first), last)
    return near, max(min(far, last), near)


@kernel(allocates=False)
def _max_row(target: Cells, pulled: Cells) -> None:
    for c in range(target.size):
        old, new = target[c], pulled[c]
        target[c] = new if new > old else old
