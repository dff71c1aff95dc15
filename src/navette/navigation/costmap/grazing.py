"""How far before its hit a beam that grazes a surface should stop freeing cells.

A beam along a wall crosses cells that the wall is in before it hits. Freeing them
would erase what a better placed scan saw: walls get holes where they are looked at
sideways. The distance from the beam to the surface, s metres before the hit, is
s · sin(incidence). It should exceed ``clearance`` in the last cell freed, as it does
where a beam meets the surface squarely and is freed up to the hit: so the margin is
clearance / sin(incidence) − clearance, nothing for a square hit.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.grids.checks import kernel_array


def grazing_margins(
    ranges: NDArray[np.float32],
    directions: NDArray[np.float64],
    *,
    range_min: float,
    range_max: float,
    clearance: float,
    most: float,
) -> NDArray[np.float32]:
    """Margin before each hit in which cells are not freed.

    The surface runs from a hit to its neighbours' hits; of the two the one that the
    beam meets more squarely counts. A hit without neighbours has no margin: it is a
    thing too small for two beams, not a surface.

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


@njit(cache=True)
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


@njit(cache=True)
def _sine(
    ranges: Any, directions: Any, i: int, j: int, range_min: float, range_max: float
) -> float:
    """Sine of the angle between beam ``i`` and the line of hits i–j; -1 = no line."""
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
