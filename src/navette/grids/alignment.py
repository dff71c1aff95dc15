"""How two grids lie to each other, and values pulled from one into the other.

Each target cell asks which source cell holds its centre (inverse mapping), so a
coarse source leaves no holes. Sampling by centres may miss a source cell that is as
small as a target cell, though, and a thin post is one cell: lethal cells are
therefore pushed, each to the one target cell that holds its centre. None is lost
and none is doubled. (A source coarser than the target pulls them like the rest.)
"""

import math
from typing import Any

import numpy as np
from numba import njit

from navette.geometry import Pose2
from navette.grids.cells import LETHAL, UNKNOWN
from navette.grids.spec import GridSpec

# Source coordinates along a row advance in fixed point: exact and fast.
FRACTION_BITS = 32
ONE = 1 << FRACTION_BITS

# Cells; breaks ties one way for all. Robots start at round poses, where each cell's
# centre lies on a border of the other grid and rounding would pick either side.
TIE = 1e-6

Affine = tuple[float, float, float, float]


def placed(spec: GridSpec, frame_T_grid: Pose2) -> GridSpec:
    """The same grid seen from another frame: its origin moved by the pose."""
    return GridSpec(
        spec.resolution, spec.width, spec.height, frame_T_grid @ spec.origin
    )


def pushes_lethal(target: GridSpec, source: GridSpec) -> bool:
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


@njit(cache=True)
def row_range(inverse: Any, width: int, height: int, rows: int) -> tuple[int, int]:
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
def pull_row(source: Any, relation: Any, row: int, lethal_as: Any, pulled: Any) -> Any:
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
def has_lethal(row: Any) -> bool:
    dearest = np.int8(UNKNOWN)
    for c in range(row.size):
        dearest = max(dearest, row[c])
    return bool(dearest >= LETHAL)


@njit(cache=True)
def related_cell(inverse: Any, r: int, c: int) -> tuple[int, int]:
    """(row, column) of the target cell that holds the centre of source cell (r, c)."""
    a, b, u0, v0 = inverse
    u = a * (c + 0.5) - b * (r + 0.5) + u0
    v = b * (c + 0.5) + a * (r + 0.5) + v0
    return math.floor(v), math.floor(u)
