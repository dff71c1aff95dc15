"""Distance to the obstacles around the robot, exact to the millimetre near them.

Between cells a distance is off by half a cell at each end, as much as the room that a
narrow passage leaves. It is therefore measured from cells to the points themselves.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.control.rollouts import LocalField

_FAR_M = 1e3
_SPAN = 32  # columns of a pass; fewer are unrolled and then not vectorised
_BLOCK = 8  # edge of the blocks in which obstacles are within reach or not, cells


def local_field(
    points: NDArray[np.float64],
    resolution: float,
    reach_m: float,
    half_cell_m: float = 0.0,
    *,
    exact_m: float = math.inf,
) -> LocalField:
    """Return the distance field of obstacle points (N, 2), map frame, m.

    Distances from ``exact_m`` on are ``exact_m`` within ``reach_m`` of an obstacle, and
    that or 1 km beyond.

    Args:
        points: obstacles.
        resolution: edge of a cell of the field, m.
        reach_m: distance beyond which an obstacle makes no difference.
        half_cell_m: radius of each point.
        exact_m: distance below which the field is exact; at most ``reach_m``.
    """
    if not len(points):
        return open_field()
    exact_m = min(exact_m, reach_m)
    distance, x, y = _measure(
        np.ascontiguousarray(points, np.float64), resolution, exact_m, reach_m
    )
    return LocalField(distance, x, y, float(resolution), half_cell_m)


def open_field() -> LocalField:
    """Return a field without obstacles."""
    return LocalField(np.full((2, 2), _FAR_M, np.float32), 0.0, 0.0, 1.0, 0.0)


@kernel
def _measure(points: Any, resolution: float, exact_m: float, reach_m: float) -> Any:
    """Return the distances (H, W), m, and the corner of the first cell."""
    margin = math.ceil(reach_m / resolution) + 2
    low_x = high_x = points[0, 0]
    low_y = high_y = points[0, 1]
    for n in range(points.shape[0]):
        low_x, high_x = min(low_x, points[n, 0]), max(high_x, points[n, 0])
        low_y, high_y = min(low_y, points[n, 1]), max(high_y, points[n, 1])
    x, y = low_x - margin * resolution, low_y - margin * resolution
    # A span from any cell near a point on ends within the row.
    width = int((high_x - x) / resolution) + margin + _SPAN
    height = int((high_y - y) / resolution) + margin
    columns, rows = width // _BLOCK + 1, height // _BLOCK + 1
    exact = exact_m / resolution
    field = np.full((rows * _BLOCK, columns * _BLOCK), np.float32(exact * exact))
    is_near = np.zeros((rows, columns), np.uint8)
    for n in range(points.shape[0]):
        u, v = (points[n, 0] - x) / resolution, (points[n, 1] - y) / resolution
        _mark(is_near, u, v, reach_m / resolution + 1.0)
        _lower(field, u - 0.5, v - 0.5, math.ceil(exact))
    for i in range(field.shape[0]):
        _finish(field[i], is_near[i // _BLOCK], np.float32(resolution))
    return field, x, y


@kernel(allocates=False)
def _mark(is_near: Any, u: float, v: float, reach: float) -> None:
    """Mark the blocks within reach of a point (cells)."""
    first, last = int((u - reach) / _BLOCK), int((u + reach) / _BLOCK)
    for row in range(int((v - reach) / _BLOCK), int((v + reach) / _BLOCK) + 1):
        for column in range(first, last + 1):
            is_near[row, column] = 1


@kernel
def _lower(square: Any, u: float, v: float, cells: int) -> None:
    """Lower the squared distances around a point, from the centres of the cells."""
    column, row = int(u), int(v)
    # The number of columns is known at compile time: four times as fast.
    for first in range(column - cells, column + cells + 2, _SPAN):
        du = np.float32(u - first)
        for i in range(row - cells, row + cells + 2):
            dv = np.float32(v - i)
            for k in range(_SPAN):
                away = du - np.float32(k)
                there = away * away + dv * dv
                at = np.uintp(first + k)
                before = square[np.uintp(i), at]
                square[np.uintp(i), at] = there if there < before else before


@kernel(allocates=False)
def _finish(line: Any, is_near: Any, resolution: Any) -> None:
    """Convert squares of cells to metres, in blocks with an obstacle within reach."""
    for block in range(is_near.size):
        part = line[block * _BLOCK : (block + 1) * _BLOCK]
        if is_near[block]:
            for k in range(_BLOCK):
                part[k] = np.sqrt(part[k]) * resolution
        else:
            for k in range(_BLOCK):
                part[k] = np.float32(_FAR_M)
