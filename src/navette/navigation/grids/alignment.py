"""Transform between the cells of two grids, and resampling of one into the other.

Each target cell takes the value of the source cell that contains its centre (inverse
mapping), so a coarse source leaves no holes. This may skip a source cell that is as
small as a target cell, and a thin post is one cell. Lethal cells are therefore also
pushed: each sets the one target cell that contains its centre, so that none is lost and
none is doubled. (A source coarser than the target needs no push.)
"""

import math
from typing import Any, NamedTuple

import numpy as np

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.grids.spec import LETHAL, Cells, GridSpec

# Source coordinates along a row advance in fixed point: exact and fast.
FRACTION_BITS = 32
ONE = 1 << FRACTION_BITS

# Cells. Robots start at round poses, where the centres of one grid's cells lie on the
# borders of the other's; the shift rounds all of them to the same side.
TIE = 1e-6

Affine = tuple[float, float, float, float]


class Alignment(NamedTuple):
    """How a source grid lies relative to a target grid.

    Attributes:
        source_T_target: (a, b, u0, v0), from target cells to source cells:
            u' = a · u − b · v + u0 and v' = b · u + a · v + v0, with u along columns
            and v along rows, counted from the grids' corners.
        target_T_source: the inverse.
        pushes_lethal: whether lethal source cells are pushed.
    """

    source_T_target: Affine
    target_T_source: Affine
    pushes_lethal: bool


def align(target: GridSpec, source: GridSpec) -> Alignment:
    """Return the alignment of two grids whose origins are given in the same frame."""
    return Alignment(
        cell_transform(source, target),
        cell_transform(target, source),
        source.resolution <= target.resolution * (1.0 + 1e-6),
    )


def placed(spec: GridSpec, frame_T_grid: Pose2) -> GridSpec:
    """Return the spec of the same grid in an outer frame."""
    return GridSpec(
        spec.resolution, spec.width, spec.height, frame_T_grid @ spec.origin
    )


def cell_transform(outer: GridSpec, inner: GridSpec) -> Affine:
    """Return the transform of cells of a grid to those of another."""
    outer_T_inner = outer.origin.inverse() @ inner.origin
    scale = inner.resolution / outer.resolution
    return (
        scale * math.cos(outer_T_inner.yaw),
        scale * math.sin(outer_T_inner.yaw),
        outer_T_inner.x / outer.resolution + TIE,
        outer_T_inner.y / outer.resolution + TIE,
    )


@kernel(allocates=False)
def row_range(source: Cells, alignment: Alignment, rows: int) -> tuple[int, int]:
    """First and last row (exclusive) of the target that the source can overlap."""
    height, width = source.shape
    a, b, _, v0 = alignment.target_T_source
    low, high = v0, v0
    for u, v in ((width, 0), (0, height), (width, height)):
        corner = b * u + a * v + v0
        low, high = min(low, corner), max(high, corner)
    return max(0, math.floor(low)), min(rows, math.ceil(high) + 1)


@kernel(allocates=False)
def _limits(
    start: float, step: float, size: int, low: float, high: float
) -> tuple[float, float]:
    """[low, high] narrowed to the t with 0 <= start + t · step < size."""
    if abs(step) < 1e-12:
        if 0.0 <= start < size:
            return low, high
        return 1.0, 0.0
    at_zero, at_size = -start / step, (size - start) / step
    return max(low, min(at_zero, at_size)), min(high, max(at_zero, at_size))


@kernel(allocates=False)
def pull_row(
    source: Cells, alignment: Alignment, row: int, lethal_as: np.int8, pulled: Cells
) -> tuple[int, int]:
    """Sample the source at the cells of one target row.

    Writes into ``pulled`` (W,), lethal cells as ``lethal_as``. Returns the first and
    last column (exclusive) that was written.
    """
    a, b, u0, v0 = alignment.source_T_target
    height, width = source.shape
    flat = source.reshape(height * width)
    # Centre of the target cell (row, 0), in source cells.
    u = a * 0.5 - b * (row + 0.5) + u0
    v = b * 0.5 + a * (row + 0.5) + v0
    low, high = _limits(u, a, width, 0.0, pulled.size - 1.0)
    low, high = _limits(v, b, height, low, high)
    if low > high:
        return 0, 0
    # One cell more at either end, then checked in the fixed point of the loop below.
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
    part = pulled[first:last]
    _sample(flat, width, (fu, fv), (du, dv), part)
    # Apart from the loop above so that the compiler vectorises it.
    _replace_lethal(part, lethal_as)
    return first, last


@kernel(allocates=False)
def _sample(flat: Cells, width: int, at: Any, step: Any, row: Cells) -> None:
    fu, fv = at
    du, dv = step
    for c in range(row.size):
        # An unsigned index avoids the check for negative ones.
        row[c] = flat[np.uint64((fv >> FRACTION_BITS) * width + (fu >> FRACTION_BITS))]
        fu += du
        fv += dv


@kernel(allocates=False)
def _replace_lethal(row: Cells, lethal_as: np.int8) -> None:
    lethal = np.int8(LETHAL)
    for c in range(row.size):
        row[c] = lethal_as if row[c] >= lethal else row[c]


@kernel(allocates=False)
def _is_in(fu: int, fv: int, width: int, height: int) -> bool:
    return 0 <= fu < width * ONE and 0 <= fv < height * ONE


@kernel(allocates=False)
def has_lethal(row: Cells) -> bool:
    lethal = False  # vectorised
    for c in range(row.size):
        lethal |= row[c] >= LETHAL
    return lethal


@kernel(allocates=False)
def cell_at(transform: Affine, row: int, column: int) -> tuple[int, int]:
    """(row, column) of the outer cell that contains the centre of an inner cell."""
    a, b, u0, v0 = transform
    u = a * (column + 0.5) - b * (row + 0.5) + u0
    v = b * (column + 0.5) + a * (row + 0.5) + v0
    return math.floor(v), math.floor(u)
