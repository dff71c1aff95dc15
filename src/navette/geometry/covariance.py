"""Measures of covariances."""

import math

import numpy as np
from numpy.typing import NDArray


def largest_stddev(covariance: NDArray[np.float64]) -> float:
    """Standard deviation of a position along its worst axis.

    Args:
        covariance: (2, 2) or larger; x and y come first.
    """
    (xx, xy), (_, yy) = covariance[:2, :2].tolist()
    # The larger eigenvalue.
    variance = 0.5 * (xx + yy) + math.hypot(0.5 * (xx - yy), xy)
    return math.sqrt(max(0.0, variance))
