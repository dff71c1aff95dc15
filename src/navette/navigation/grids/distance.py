"""Distance to the nearest obstacle: exact, within a window.

Method: a vertical pass gives each cell the distance g to the nearest obstacle in its
own column; then along each row d² = min over k of g(c + k)² + k² (Meijster, Roerdink
and Hesselink 2000, phases 1 and 2). Only |k| <= radius matters, so the minimum is taken
over the window instead of by lower envelopes; the compiler vectorises that loop.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.navigation.grids.checks import at_least, kernel_array

# Columns per block: long enough for vector loops, short enough to skip empty space.
BLOCK = 256
# Largest radius whose sums of squares, up to 2 · (radius + 1)², fit 16 bits.
RADIUS_16_BIT = 179
# Largest radius whose square fits int32.
MAX_RADIUS = 46_339

Occupied = NDArray[np.uint8]


def distance_field(
    occupied: Occupied, resolution: float, max_distance_m: float
) -> NDArray[np.float32]:
    """Distance to the nearest obstacle in metres, between cell centres.

    Args:
        occupied: (H, W), non-zero = obstacle.
        resolution: edge of a cell, m.
        max_distance_m: search radius; the running time grows with it.

    Returns:
        (H, W) float32, exact below ``max_distance_m`` and clipped to it.

    Raises:
        InvalidValueError: a resolution or distance out of range, or a wrong array.
    """
    occupied = kernel_array("occupied", occupied, np.uint8)
    at_least("resolution", resolution, 1e-9)
    at_least("max_distance_m", max_distance_m, 0.0)
    scratch = make_scratch(occupied.shape, math.ceil(max_distance_m / resolution))
    table = metres_by_square(resolution, scratch.radius, max_distance_m)
    field = np.empty(occupied.shape, np.float32)
    field_kernel(occupied, scratch, table, field)
    return field


def square_field(occupied: Occupied, radius_cells: int) -> NDArray[np.integer[Any]]:
    """Squared distance to the nearest obstacle in cells², between cell centres.

    Args:
        occupied: (H, W), non-zero = obstacle.
        radius_cells: search radius.

    Returns:
        (H, W) uint16 or int32, exact up to ``radius_cells``² and beyond that
        (``radius_cells`` + 1)².

    Raises:
        InvalidValueError: a radius out of range, or a wrong array.
    """
    occupied = kernel_array("occupied", occupied, np.uint8)
    scratch = make_scratch(occupied.shape, radius_cells)
    most = (radius_cells + 1) ** 2
    kind = np.uint16 if most <= np.iinfo(np.uint16).max else np.int32
    table = np.minimum(np.arange((scratch.radius + 1) ** 2 + 1), most).astype(kind)
    table[-1] = most
    field = np.empty(occupied.shape, kind)
    field_kernel(occupied, scratch, table, field)
    return field


def metres_by_square(
    resolution: float, radius: int, max_distance_m: float
) -> NDArray[np.float32]:
    """Return the distance by its square in cells, up to (radius + 1)²: none found."""
    metres = resolution * np.sqrt(np.arange((radius + 1) ** 2 + 1))
    table = np.minimum(metres, max_distance_m).astype(np.float32)
    table[-1] = max_distance_m
    return table


class Scratch(NamedTuple):
    """Work arrays of the distance kernels, in the smallest sufficient integers.

    Attributes:
        radius: search radius in cells, at most the grid's diagonal.
        columns: (H, W) distance along the column, cells.
        padded: (W + 2 · radius,) squares of one row of ``columns``, with margins.
        row: (W,) squared distances of that row, cells².
    """

    radius: int
    columns: NDArray[Any]
    padded: NDArray[Any]
    row: NDArray[Any]


def make_scratch(shape: tuple[int, ...], radius_cells: int) -> Scratch:
    """Allocate work arrays for a grid of ``shape`` (H, W)."""
    at_least("radius_cells", radius_cells, 0)
    if radius_cells > MAX_RADIUS:
        raise InvalidValueError(
            f"radius_cells: {radius_cells}, must be at most {MAX_RADIUS}"
        )
    height, width = shape
    radius = min(int(radius_cells), math.ceil(math.hypot(height, width)))
    small = radius <= RADIUS_16_BIT
    squares = np.uint16 if small else np.int32
    return Scratch(
        radius,
        np.empty((height, width), np.uint8 if small else np.int32),
        np.empty(width + 2 * radius, squares),
        np.empty(width, squares),
    )


@kernel(allocates=False)
def _first_row(occupied: Any, row: Any, far: Any, zero: Any) -> None:
    for c in range(row.size):
        row[c] = far if occupied[c] == 0 else zero


@kernel
def _step_down(
    above: Any, occupied: Any, row: Any, far: Any, zero: Any, one: Any
) -> None:
    for c in range(row.size):
        further = row.dtype.type(above[c] + one)
        further = further if further < far else far
        row[c] = further if occupied[c] == 0 else zero


@kernel
def _step_up(below: Any, row: Any, one: Any) -> None:
    for c in range(row.size):
        further = row.dtype.type(below[c] + one)
        row[c] = further if further < row[c] else row[c]


@kernel
def column_distances(occupied: Occupied, scratch: Scratch) -> None:
    """Phase 1: distance to the nearest obstacle in the same column, cells.

    One function per row: only then does the compiler see that rows do not overlap
    (ten times faster than the same loops written in place). Also fills the margins
    of ``scratch.padded`` for phase 2.
    """
    radius, columns, padded = scratch.radius, scratch.columns, scratch.padded
    padded[:] = padded.dtype.type((radius + 1) * (radius + 1))
    T = columns.dtype.type
    far, zero, one = T(radius + 1), T(0), T(1)
    height = columns.shape[0]
    _first_row(occupied[0], columns[0], far, zero)
    for r in range(1, height):
        _step_down(columns[r - 1], occupied[r], columns[r], far, zero, one)
    for r in range(height - 2, -1, -1):
        _step_up(columns[r + 1], columns[r], one)


@kernel
def block_minimum(padded: Any, radius: int, limit: Any, block: Any) -> None:
    """Phase 2 for ``block``; ``padded`` has ``radius`` more cells on each side."""
    T = padded.dtype.type
    n = block.size
    nearest = limit
    for i in range(n + 2 * radius):
        nearest = min(nearest, padded[i])
    middle = padded[radius : radius + n]
    for i in range(n):
        block[i] = middle[i]
    if nearest >= limit:
        return
    k = 1
    while k <= radius:
        stop = min(k + 4, radius + 1)
        for offset in range(k, stop):
            offset2 = T(offset * offset)
            left = padded[radius - offset : radius - offset + n]
            right = padded[radius + offset : radius + offset + n]
            for i in range(n):
                there = T(min(left[i], right[i]) + offset2)
                block[i] = there if there < block[i] else block[i]
        k = stop
        furthest = T(0)
        for i in range(n):
            furthest = max(furthest, block[i])
        if nearest + k * k >= furthest:
            return


@kernel
def row_squares(scratch: Scratch, r: int) -> NDArray[Any]:
    """Phase 2: squared distances (W,) of row ``r``, in ``scratch.row``."""
    radius, padded, row = scratch.radius, scratch.padded, scratch.row
    columns = scratch.columns[r]
    T = padded.dtype.type
    width = row.size
    limit = T((radius + 1) * (radius + 1))
    middle = padded[radius : radius + width]
    for c in range(width):
        middle[c] = T(columns[c]) * T(columns[c])
    for start in range(0, width, BLOCK):
        stop = min(start + BLOCK, width)
        window = padded[start : stop + 2 * radius]
        block_minimum(window, radius, limit, row[start:stop])
    return row


@kernel
def field_kernel(
    occupied: Occupied,
    scratch: Scratch,
    table: NDArray[Any],
    field: NDArray[Any],
) -> None:
    """Write the entry of ``table`` for the squared distance of each cell."""
    column_distances(occupied, scratch)
    for r in range(field.shape[0]):
        row, out = row_squares(scratch, r), field[r]
        for c in range(row.size):
            out[c] = table[row[c]]
