"""Distances to the nearest obstacle as levels, updated where obstacles change.

A level is a small integer for a squared distance in cells: it takes half the memory of
metres, and none where no obstacle is within reach (:func:`.sparse.sparse_zeros`).
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.navigation.grids.checks import kernel_array
from navette.navigation.grids.distance import (
    BLOCK,
    Occupied,
    Scratch,
    block_minimum,
    column_distances,
    field_kernel,
    make_scratch,
    metres_by_square,
)
from navette.navigation.grids.windows import CellWindow

# Columns of a row that :func:`update_levels` computes together, or leaves out.
PART = 32
# Largest radius whose levels, a table of its square, are worth their memory.
MAX_LEVEL_RADIUS = 2_000

Parts = NDArray[np.bool_]
"""(H, W / PART, rounded up): parts of the rows of a grid."""


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
    return metres_by_square(resolution, radius, max_distance_m)[::-1].copy()


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
    field_kernel(occupied, scratch, table, level)
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
    block_minimum(padded[start : stop + 2 * radius], radius, limit, span)
    return span
