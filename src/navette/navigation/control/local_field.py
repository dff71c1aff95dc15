"""Distance to the obstacles around the robot, exact to the millimetre near them.

Between cells a distance is off by half a cell at each end, as much as the room that a
narrow passage leaves. Near the obstacles it is measured to the points themselves.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.control.rollouts import LocalField
from navette.navigation.grids import distance_field

_NEAR_M = 0.35  # exact distances: clearances that cost, and the discs in the body
_SPAN = 16  # columns of a pass: those near a point with cells of 0.05 m


def local_field(
    points: NDArray[np.float64],
    resolution: float,
    far_m: float,
    half_cell_m: float = 0.0,
    *,
    search_m: float = math.inf,
) -> LocalField:
    """Return the distance field of obstacle points (N, 2), map frame, m.

    Args:
        points: centres of obstacle cells.
        resolution: edge of a cell of the field, m.
        far_m: width of the field around the points.
        half_cell_m: half the edge of the obstacles' cells.
        search_m: distance beyond which more makes no difference; at most far_m.
    """
    if not len(points):
        return open_field()
    low = points.min(axis=0) - far_m
    high = points.max(axis=0) + far_m
    width, height = np.ceil((high - low) / resolution).astype(int) + 1
    cells = np.ascontiguousarray((points - low) / resolution, np.float64)
    lethal = np.zeros((height, width), np.uint8)
    column, row = cells.astype(np.int64).T
    lethal[row, column] = 1
    most_m = min(search_m, far_m)
    distance = distance_field(lethal, resolution, most_m)
    _measure(distance, cells, resolution, min(_NEAR_M, most_m))
    return LocalField(
        distance, float(low[0]), float(low[1]), float(resolution), half_cell_m
    )


def open_field() -> LocalField:
    """Return a field without obstacles."""
    return LocalField(np.full((2, 2), 1e3, np.float32), 0.0, 0.0, 1.0, 0.0)


@kernel
def _measure(
    distance: NDArray[np.float32],
    points: NDArray[np.float64],
    resolution: float,
    near_m: float,
) -> None:
    """Replace the distances below ``near_m`` by those to the points (N, 2), cells."""
    height, width = distance.shape
    reach = near_m / resolution
    cells = math.ceil(reach)
    columns = width + _SPAN  # a span from any cell on ends within the row
    square = np.full((height, columns), np.float32(np.inf))
    du2 = np.empty(_SPAN)
    for n in range(points.shape[0]):
        u, v = points[n, 0] - 0.5, points[n, 1] - 0.5
        column, row = int(u), int(v)
        # The number of columns is known at compile time: twice as fast.
        for first in range(max(0, column - cells), column + cells + 2, _SPAN):
            for k in range(_SPAN):
                away = u - (first + k)
                du2[k] = away * away
            for i in range(max(0, row - cells), min(height, row + cells + 2)):
                dv2 = (v - i) * (v - i)
                line = square[i, first : first + _SPAN]
                for k in range(_SPAN):
                    there = np.float32(du2[k] + dv2)
                    line[k] = there if there < line[k] else line[k]
    for i in range(height):
        _join(distance[i], square[i, :width], reach * reach, near_m, resolution)


@kernel
def _join(
    line: Any, square: Any, reach2: float, near_m: float, resolution: float
) -> None:
    """Take the exact distances within reach; the others are at least ``near_m``."""
    F = np.float32
    for k in range(line.size):
        further = max(line[k], F(near_m))
        exact = np.sqrt(square[k]) * F(resolution)
        line[k] = exact if square[k] <= F(reach2) else further
