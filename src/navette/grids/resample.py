"""One grid laid over another: pull values across a rotation and shift.

Each target cell asks which source cell holds its centre (inverse mapping), so a
coarse source leaves no holes. Sampling by centres may miss a source cell that is as
small as a target cell, though, and a thin post is one cell: lethal cells are
therefore pushed, each to the one target cell that holds its centre. None is lost
and none is doubled. (A source coarser than the target pulls them like the rest.)
"""

import math
from typing import Any, Literal

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.grids.cells import LETHAL, UNKNOWN
from navette.grids.checks import grid_array, output_array
from navette.grids.spec import GridSpec

MergeMode = Literal["overwrite", "max"]

# Source coordinates along a row advance in fixed point: exact and fast.
FRACTION_BITS = 32
ONE = 1 << FRACTION_BITS

# Cells; breaks ties one way for all. Robots start at round poses, where each cell's
# centre lies on a border of the other grid and rounding would pick either side.
TIE = 1e-6

Affine = tuple[float, float, float, float]


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
    push = _pushes_lethal(target_spec, source_spec)
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
    push = _pushes_lethal(target_spec, source_spec)
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


def _to_cells(spec: GridSpec, point: tuple[float, float]) -> tuple[float, float]:
    """(u, v): columns and rows from the grid's corner to a point of its frame."""
    corner_T_point = spec.origin.inverse() @ Pose2(*point, 0.0)
    return corner_T_point.x / spec.resolution, corner_T_point.y / spec.resolution


def _pushes_lethal(target: GridSpec, source: GridSpec) -> bool:
    return source.resolution <= target.resolution * (1.0 + 1e-6)


def grid_relation(outer: GridSpec, inner: GridSpec) -> Affine:
    """(a, b, u, v) that take inner cells to outer cells.

    u' = a · u − b · v + u0 and v' = b · u + a · v + v0, with u along columns and v
    along rows, counted from the grids' corners.
    """
    outer_T_inner = outer.origin.inverse() @ inner.origin
    scale = inner.resolution / outer.resolution
    return (
        scale * math.cos(outer_T_inner.yaw),
        scale * math.sin(outer_T_inner.yaw),
        outer_T_inner.x / outer.resolution + TIE,
        outer_T_inner.y / outer.resolution + TIE,
    )


def placed(spec: GridSpec, frame_T_grid: Pose2) -> GridSpec:
    """The same grid seen from another frame: its origin moved by the pose."""
    return GridSpec(
        spec.resolution, spec.width, spec.height, frame_T_grid @ spec.origin
    )


@njit(cache=True)
def _row_range(inverse: Any, width: int, height: int, rows: int) -> tuple[int, int]:
    """Rows of the target that a source of (width, height) cells can touch."""
    _, b, _, v0 = inverse
    a = inverse[0]
    low, high = v0, v0
    for u, v in ((width, 0), (0, height), (width, height)):
        corner = b * u + a * v + v0
        low, high = min(low, corner), max(high, corner)
    return max(0, math.floor(low)), min(rows, math.ceil(high) + 1)


@njit(cache=True)
def _limits(start: float, step: float, size: int, low: float, high: float) -> Any:
    """[low, high] narrowed to the t with 0 <= start + t · step < size."""
    if abs(step) < 1e-12:
        if 0.0 <= start < size:
            return low, high
        return 1.0, 0.0
    at_zero, at_size = -start / step, (size - start) / step
    return max(low, min(at_zero, at_size)), min(high, max(at_zero, at_size))


@njit(cache=True)
def _pull_row(source: Any, relation: Any, row: int, lethal_as: Any, pulled: Any) -> Any:
    """Pull one target row into ``pulled`` (W,); (first, last) column written, last
    exclusive. A lethal cell is pulled as ``lethal_as``."""
    a, b, u0, v0 = relation
    height, width = source.shape
    flat = source.reshape(height * width)
    # Centre of the target cell (row, 0), in source cells.
    u = a * 0.5 - b * (row + 0.5) + u0
    v = b * 0.5 + a * (row + 0.5) + v0
    low, high = _limits(u, a, width, 0.0, pulled.size - 1.0)
    low, high = _limits(v, b, height, low, high)
    if low > high:
        return 0, 0
    # One further at either end, then checked in the fixed point that the loop uses.
    first = max(0, int(low) - 1)
    last = min(pulled.size, int(high) + 3)
    du, dv = round(a * ONE), round(b * ONE)
    fu, fv = round(u * ONE) + first * du, round(v * ONE) + first * dv
    while first < last and not _is_in(fu, fv, width, height):
        first, fu, fv = first + 1, fu + du, fv + dv
    while first < last and not _is_in(
        fu + (last - 1 - first) * du, fv + (last - 1 - first) * dv, width, height
    ):
        last -= 1
    for c in range(first, last):
        # Unsigned: spares the check for a negative index.
        value = flat[np.uint64((fv >> FRACTION_BITS) * width + (fu >> FRACTION_BITS))]
        pulled[c] = value
        fu += du
        fv += dv
    # Apart from the loop above: this one runs on whole registers.
    _replace_lethal(pulled[first:last], lethal_as)
    return first, last


@njit(cache=True)
def _replace_lethal(row: Any, lethal_as: Any) -> None:
    lethal = np.int8(LETHAL)
    for c in range(row.size):
        row[c] = lethal_as if row[c] >= lethal else row[c]


@njit(cache=True)
def _is_in(fu: int, fv: int, width: int, height: int) -> bool:
    return 0 <= fu < width * ONE and 0 <= fv < height * ONE


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
    first_row, last_row = _row_range(inverse, width, height, target.shape[0])
    for r in range(first_row, last_row):
        first, last = _pull_row(source, relation, r, lethal_as, pulled)
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
            if _has_lethal(source[r]):
                _push_lethal(target, source[r], inverse, r)


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
    first_row, last_row = _row_range(inverse, width, height, field.shape[0])
    for r in range(first_row, last_row):
        first, last = _pull_row(source, relation, r, lethal_as, pulled)
        for c in range(first, last):
            if pulled[c] >= 0:
                step = hit if pulled[c] >= LETHAL else miss
                field[r, c] = _added(field[r, c], step, limit)
    if lethal_as < LETHAL:
        for r in range(height):
            if _has_lethal(source[r]):
                _push_hits(field, source[r], inverse, r, hit, limit)


@njit(cache=True)
def _has_lethal(row: Any) -> bool:
    dearest = np.int8(UNKNOWN)
    for c in range(row.size):
        dearest = max(dearest, row[c])
    return bool(dearest >= LETHAL)


@njit(cache=True)
def _push_lethal(target: Any, source: Any, inverse: Any, r: int) -> None:
    """Set the target cells that hold the centres of row ``r``'s lethal cells."""
    for c in range(source.size):
        if source[c] >= LETHAL:
            row, column = related_cell(inverse, r, c)
            if 0 <= row < target.shape[0] and 0 <= column < target.shape[1]:
                target[row, column] = LETHAL


@njit(cache=True)
def _push_hits(
    field: Any, source: Any, inverse: Any, r: int, hit: Any, limit: Any
) -> None:
    """:func:`_push_lethal` for a field of log odds."""
    for c in range(source.size):
        if source[c] >= LETHAL:
            row, column = related_cell(inverse, r, c)
            if 0 <= row < field.shape[0] and 0 <= column < field.shape[1]:
                field[row, column] = _added(field[row, column], hit, limit)


@njit(cache=True)
def _added(now: Any, step: Any, limit: Any) -> Any:
    total = step if math.isnan(now) else now + step
    return min(max(total, -limit), limit)


@njit(cache=True)
def related_cell(inverse: Any, r: int, c: int) -> tuple[int, int]:
    """(row, column) of the target cell that holds the centre of source cell (r, c)."""
    a, b, u0, v0 = inverse
    u = a * (c + 0.5) - b * (r + 0.5) + u0
    v = b * (c + 0.5) + a * (r + 0.5) + v0
    return math.floor(v), math.floor(u)


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
