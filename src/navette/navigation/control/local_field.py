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


def local_field(
    points: NDArray[np.float64],
    resolution: float,
    reach_m: float,
    half_cell_m: float = 0.0,
) -> LocalField:
    """Return the distance field of obstacle points (N, 2), map frame, m.

    Args:
        points: obstacles.
        resolution: edge of a cell of the field, m.
        reach_m: the largest distance of the field, beyond which an obstacle makes no
            difference.
        half_cell_m: radius of each point.
    """
    if not len(points):
        return open_field()
    distance, x, y = _measure(
        np.ascontiguousarray(points, np.float64), resolution, reach_m
    )
    return LocalField(distance, x, y, float(resolution), half_cell_m)


def open_field() -> LocalField:
    """Return a field without obstacles."""
    return LocalField(np.full((2, 2), _FAR_M, np.float32), 0.0, 0.0, 1.0, 0.0)


@kernel
def _measure(points: Any, resolution: float, reach_m: float) -> Any:
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
    reach = reach_m / resolution
    field = np.full((height, width), np.float32(reach * reach))
    for n in range(points.shape[0]):
        u, v = (points[n, 0] - x) / resolution, (points[n, 1] - y) / resolution
        _lower(field, u - 0.5, v - 0.5, reach)
    _to_metres(field.reshape(-1), np.float32(resolution))
    return field, x, y


@kernel(allocates=False)
def _lower(square: Any, u: float, v: float, reach: float) -> None:
    """Lower the squared distances around a point, from the centres of the cells."""
    # The number of columns is known at compile time: four times as fast.
    for first in range(int(u - reach) + 1, int(u + reach) + 1, _SPAN):
        du = np.float32(u - first)
        for i in range(int(v - reach) + 1, int(v + reach) + 1):
            dv = np.float32(v - i)
            line = square[np.uintp(i)]
            for k in range(_SPAN):
                away = du - np.float32(k)
                there = away * away + dv * dv
                at = np.uintp(first + k)
                before = line[at]
                # abs() changes no square. Without it, LLVM stores through a mask,
                # which takes four times as long on processors of AMD.
                line[at] = abs(there if there < before else before)


@kernel(allocates=False)
def _to_metres(squares: Any, resolution: Any) -> None:
    for k in range(squares.size):
        squares[k] = np.sqrt(squares[k]) * resolution
