"""Margin before the hit of a grazing beam in which cells are not marked free.

A beam along a wall crosses cells of the wall before its hit. Marking them free would
erase what a scan from a better position measured, and walls would get holes. The
distance from the beam to the surface, s metres before the hit, is s · sin(incidence).
It should exceed ``clearance`` in the last free cell, as for a perpendicular beam that
frees all cells up to the hit: so the margin is clearance / sin(incidence) − clearance,
which is 0 for a perpendicular hit.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids.checks import kernel_array


def grazing_margins(
    ranges: NDArray[np.float32],
    directions: NDArray[np.float64],
    *,
    range_min: float,
    range_max: float,
    clearance: float,
    most: float,
) -> NDArray[np.float32]:
    """Return the margin before each hit in which cells are not marked free.

    The surface runs from a hit to its neighbours' hits; of both, the one more
    perpendicular to the beam counts. A hit without neighbours has no margin: the object
    is too small for two beams.

    Args:
        ranges: (N,) float32, m.
        directions: (N, 2) unit vectors.
        range_min: least valid range, m.
        range_max: largest valid range, m.
        clearance: distance to keep from the surface, m.
        most: the largest margin, m.

    Returns:
        (N,) float32 metres.
    """
    metres = kernel_array("ranges", ranges, np.float32, 1, allow_empty=True)
    rays = kernel_array("directions", directions, np.float64, allow_empty=True)
    margins = np.zeros_like(metres)
    _margins_kernel(
        metres,
        rays,
        float(range_min),
        float(range_max),
        float(clearance),
        float(most),
        margins,
    )
    return margins


@kernel(allocates=False)
def _margins_kernel(
    ranges: Any,
    directions: Any,
    range_min: float,
    range_max: float,
    clearance: float,
    most: float,
    margins: Any,
) -> None:
    count = ranges.size
    last = -1.0
    for i in range(count):
        here = _sine(ranges, directions, i, i + 1, range_min, range_max)
        squarest = max(here, last)
        last = here
        if squarest >= 0.0:
            squarest = max(squarest, 1e-9)
            margins[i] = min(clearance / squarest - clearance, most)


@kernel(allocates=False)
def _sine(
    ranges: Any, directions: Any, i: int, j: int, range_min: float, range_max: float
) -> float:
    """Return the sine of the angle between beam i and the line i–j; -1 = no line."""
    if j >= ranges.size:
        return -1.0
    if not (range_min < ranges[i] < range_max and range_min < ranges[j] < range_max):
        return -1.0
    dx = ranges[j] * directions[j, 0] - ranges[i] * directions[i, 0]
    dy = ranges[j] * directions[j, 1] - ranges[i] * directions[i, 1]
    length = np.hypot(dx, dy)
    if length == 0.0:
        return 1.0
    sine: float = abs(dx * directions[i, 1] - dy * directions[i, 0]) / length
    return sine
