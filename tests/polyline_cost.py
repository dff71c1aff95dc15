"""Cost of a line over a grid, summed segment by segment."""

import itertools

import numpy as np

from navette.navigation.planning.string_pulling import segment_cost
from navette.navigation.planning.traversal import STRAIGHT, EdgeTable


def line_cost(
    cost: np.ndarray, points: np.ndarray, *, table: EdgeTable | None = None
) -> float:
    """Return the cost of a polyline (N, 2) u, v in cells; a free cell's width costs 1.

    Infinite if it meets a closed cell.
    """
    factor = (table or EdgeTable()).straight / STRAIGHT
    segments = itertools.pairwise(np.asarray(points, np.float64).tolist())
    return sum(segment_cost(cost, *a, *b, factor) for a, b in segments)
