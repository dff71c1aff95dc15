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
from navette.navigation.grids.windows import CellWindow

# Columns per block: long enough for vector loops, short enough to skip empty space.
BLOCK = 256
# Columns of a row that :func:`update_levels` computes together, or leaves out.
PART = 32
# Largest radius whose sums of squares, up to 2 · (radius + 1)², fit 16 bits.
RADIUS_16_BIT = 179
# Largest radius whose square fits int32.
MAX_RADIUS = 46_339
# Largest radius whose levels, a table of its square, are worth their memory.
MAX_LEVEL_RADIUS = 2_000

Occupied = NDArray[np.uint8]
Parts = NDArray[np.bool_]
"""(H, W / PART, rounded up): parts of the rows of a grid."""


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
    table = _metres(resolution, scratch.radius, max_distance_m)
    field = np.empty(occupied.shape, np.float32)
    _field_kernel(occupied, scratch, table, field)
    return field


class DistanceLevels(NamedTuple):
    """Distances by level: half the memory of metres, none where all are far.

    Attributes:
        level: (H, W) uint16 or uint32: 0 = no obstacle within reach, nearer is higher.
        metres: (n,) float32, distance by level; exact, as of :func:`distance_field`.
    """

    level: NDArray[Any]
    metres: NDArray[np.float32]

    def everywhere(self) -> NDArray[np.float32]:
        """Return (H, W) float32 the distances in metres."""
        return np.take(self.metres, self.level)


def level_metres(resolution: float, max_distance_m: float) -> NDArray[np.float32]:
    """Return (n,) float32 the distances (m) by level, of all up to a largest one.

    A level is ``n − 1`` less the squared distance in cells.
    """
    radius = math.ceil(max_distance_m / resolution)
    if radius > MAX_LEVEL_RADIUS:
        raise InvalidValueError(
            f"max_distance_m: {max_distance_m}, must be at most {MAX_LEVEL_RADIUS} "
            f"cells of {resolution} m"
        )
    return _metres(resolution, radius, max_distance_m)[::-1].copy()


def level_type(metres: NDArray[np.float32]) -> Any:
    """Return the type of levels with these distances."""
    return np.uint16 if len(metres) <= 1 << 16 else np.uint32


def distance_levels(occupied: Occupied, metres: NDArray[np.float32]) -> NDArray[Any]:
    """Return the levels (H, W) of the distances to the nearest obstacle.

    Args:
        occupied: (H, W), non-zero = obstacle.
        metres: of :func:`level_metres`.
    """
    occupied = kernel_array("occupied", occupied, np.uint8)
    scratch = make_scratch(occupied.shape, radius_of(metres))
    table = _levels(metres, scratch.radius)
    level = np.empty(occupied.shape, table.dtype)
    _field_kernel(occupied, scratch, table, level)
    return level


def all_parts(shape: tuple[int, ...]) -> Parts:
    """Return all parts of a grid of ``shape`` (H, W)."""
    return np.ones((shape[0], -(-shape[1] // PART)), np.bool_)


def parts_near(cells: NDArray[np.int64], reach: int, shape: tuple[int, ...]) -> Parts:
    """Return the parts of a grid of ``shape`` (H, W) near cells (N, 2) row, column.

    ``reach`` is the largest difference of rows, and of columns.
    """
    parts = np.zeros((shape[0], -(-shape[1] // PART)), np.bool_)
    _mark_parts(cells, reach, parts)
    return parts


def update_levels(
    level: NDArray[Any],
    occupied: Occupied,
    metres: NDArray[np.float32],
    window: CellWindow,
    parts: Parts,
) -> None:
    """Compute parts of a window of :func:`distance_levels` again, in place.

    Args:
        level: (H, W) for the same distances.
        occupied: (H, W), non-zero = obstacle.
        metres: of :func:`level_metres`.
        window: not empty.
        parts: to compute; the others keep their values.
    """
    around = window.grown(radius_of(metres), occupied.shape)
    obstacles = np.ascontiguousarray(occupied[around.slices])
    scratch = make_scratch(obstacles.shape, radius_of(metres))
    table = _levels(metres, scratch.radius)
    _update_kernel(obstacles, scratch, table, window, around, parts, level)


def radius_of(metres: NDArray[np.float32]) -> int:
    """Return the largest distance of :func:`level_metres`, in cells, rounded up."""
    return math.isqrt(len(metres) - 1) - 1


def _levels(metres: NDArray[np.float32], radius: int) -> NDArray[Any]:
    """Return the level by the squared distance in cells, up to (radius + 1)²."""
    squares = np.arange((radius + 1) ** 2 + 1)
    table = (len(metres) - 1 - squares).astype(level_type(metres))
    table[-1] = 0  # no obstacle found
    return table


def _metres(
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
def _block_minimum(padded: Any, radius: int, limit: Any, block: Any) -> None:
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
        _block_minimum(window, radius, limit, row[start:stop])
    return row


@kernel
def _field_kernel(
    occupied: Occupied,
    scratch: Scratch,
    table: NDArray[Any],
    field: NDArray[Any],
) -> None:
    column_distances(occupied, scratch)
    for r in range(field.shape[0]):
        row, out = row_squares(scratch, r), field[r]
        for c in range(row.size):
            out[c] = table[row[c]]


@kernel(allocates=False)
def _mark_parts(cells: Any, reach: int, parts: Any) -> None:
    height, width = parts.shape
    for k in range(cells.shape[0]):
        row, column = cells[k, 0], cells[k, 1]
        first = max(0, column - reach) // PART
        last = min(width - 1, (column + reach) // PART)
        for r in range(max(0, row - reach), min(height, row + reach + 1)):
            for part in range(first, last + 1):
                parts[r, part] = True


@kernel
def _update_kernel(
    occupied: Occupied,
    scratch: Scratch,
    table: NDArray[Any],
    window: CellWindow,
    around: CellWindow,
    parts: Parts,
    field: NDArray[Any],
) -> None:
    """Compute parts of ``window``; ``occupied`` is of the window ``around`` it."""
    column_distances(occupied, scratch)
    end = window.last_column
    for r in range(window.first_row, window.last_row):
        start = window.first_column
        while start < end:
            stop = min((start // PART + 1) * PART, end)
            if not parts[r, start // PART]:
                start = stop
                continue
            while stop < end and stop - start < BLOCK and parts[r, stop // PART]:
                stop = min(stop + PART, end)
            shift = around.first_column
            squares = _span_squares(
                scratch, r - around.first_row, start - shift, stop - shift
            )
            out = field[r, start:stop]
            for c in range(squares.size):
                out[c] = table[squares[c]]
            start = stop


@kernel
def _span_squares(scratch: Scratch, r: int, start: int, stop: int) -> NDArray[Any]:
    """Phase 2: squared distances of the columns [start, stop) of row ``r``."""
    radius, padded = scratch.radius, scratch.padded
    T = padded.dtype.type
    first, last = max(0, start - radius), min(scratch.row.size, stop + radius)
    columns, needed = (
        scratch.columns[r, first:last],
        padded[first + radius : last + radius],
    )
    for c in range(columns.size):
        needed[c] = T(columns[c]) * T(columns[c])
    span = scratch.row[start:stop]
    limit = T((radius + 1) * (radius + 1))
    _block_minimum(padded[start : stop + 2 * radius], radius, limit, span)
    return span
