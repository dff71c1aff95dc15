"""Low-variance resampling with a number of particles adapted to their spread.

Thrun, Burgard, Fox, "Probabilistic Robotics" (2005), sections 4.2.4 (low variance) and
8.3.7 (KLD sampling; Fox 2003).
"""

import math
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from navette.navigation.localization.amcl.bins import bin_keys

# Bins of KLD sampling, as Nav2's.
_BIN_M, _BIN_RAD = 0.5, math.radians(10.0)


def occupied_bins(particles: NDArray[np.float64]) -> int:
    """Return the number of bins of x, y, yaw that particles (N, 3) occupy."""
    return len(np.unique(bin_keys(particles, _BIN_M, _BIN_RAD)))


def kld_limit(bins: int, error: float, quantile: float) -> int:
    """Return the particles that make the sampling error small with high probability.

    ``n = (k − 1) / 2ε · (1 − 2 / 9(k − 1) + √(2 / 9(k − 1)) z)³`` for k bins, the
    error ε of the Kullback–Leibler divergence and the normal quantile z.
    """
    if bins <= 1:
        return 1
    k = bins - 1
    a = 2.0 / (9.0 * k)
    z = NormalDist().inv_cdf(quantile)
    return math.ceil(k / (2.0 * error) * (1.0 - a + math.sqrt(a) * z) ** 3)


def resampled(
    particles: NDArray[np.float64],
    weights: NDArray[np.float64],
    count: int,
    rng: np.random.Generator,
) -> NDArray[np.float64]:
    """Return ``count`` particles drawn by weight with one random number."""
    edges = np.cumsum(weights)
    at = (rng.random() + np.arange(count)) * (edges[-1] / count)
    chosen = np.minimum(np.searchsorted(edges, at, side="right"), len(weights) - 1)
    drawn: NDArray[np.float64] = particles[chosen]
    return drawn
