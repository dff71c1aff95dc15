"""Distance to the obstacles around the robot, exact to the millimetre near them.

Between cells a distance is off by half a cell at each end, as much as the room that a
narrow passage leaves. Near the obstacles it is measured to the points themselves.
"""

import math

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.control.rollouts import LocalField
from navette.navigation.grids import distance_field

_NEAR_M = 0.35  # exact distances: clearances that cost, and the discs in the body


def local_field(
    points: NDArray[np.float64],
    resolution: float,
    far_m: float,
    half_cell_m: float = 0.0,
) -> LocalField:
    """Return the distance field of obstacle points (N, 2), map frame, m.

    Args:
        points: centres of obstacle cells.
        resolution: edge of a cell of the field, m.
        far_m: distance beyond which more makes no difference.
        half_cell_m: half the edge of the obstacles' cells.
    """
    if not len(points):
        return open_field()
    low = points.min(axis=0) - far_m
    high = points.max(axis=0) + far_m
    width, height = np.ceil((high - low) / resolution).astype(int) + 1
    lethal = np.zeros((height, width), np.uint8)
    column, row = np.floor((points - low) / resolution).astype(np.int64).T
    lethal[row, column] = 1
    distance = distance_field(lethal, resolution, far_m)
    square = np.full(distance.shape, np.inf, np.float32)
    cells = np.ascontiguousarray((points - low) / resolution, np.float64)
    _measure(square, cells, _NEAR_M / resolution)
    near = square <= (_NEAR_M / resolution) ** 2
    np.maximum(distance, np.float32(min(_NEAR_M, far_m)), out=distance)
    distance[near] = np.sqrt(square[near]) * np.float32(resolution)
    return LocalField(
        distance, float(low[0]), float(low[1]), float(resolution), half_cell_m
    )


def open_field() -> LocalField:
    """Return a field without obstacles."""
    return LocalField(np.full((2, 2), 1e3, np.float32), 0.0, 0.0, 1.0, 0.0)


@kernel(nogil=True)
def _measure(
    square: NDArray[np.float32], points: NDArray[np.float64], reach: float
) -> None:
    """Lower the squared distances of the cell centres near each point; in cells."""
    height, width = square.shape
    cells = math.ceil(reach)
    for n in range(points.shape[0]):
        u, v = points[n, 0] - 0.5, points[n, 1] - 0.5
        column, row = int(u), int(v)
        first, last = max(0, column - cells), min(width, column + cells + 2)
        for i in range(max(0, row - cells), min(height, row + cells + 2)):
            dv = (v - i) * (v - i)
            line = square[i]
            for j in range(first, last):
                there = np.float32((u - j) * (u - j) + dv)
                line[j] = min(line[j], there)
