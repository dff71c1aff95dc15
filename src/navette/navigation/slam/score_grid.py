"""Likelihood grid of points, with coarser levels for upper bounds of a score."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.slam.scan_points import Points

# Width of the likelihood about a point, in cells, and where it is cut off.
_SIGMA_CELLS = 0.8
_CUT_CELLS = 2
LARGEST = 250.0
"""Value of the highest likelihood."""


class ScoreGrid(NamedTuple):
    """Likelihood of a hit by position.

    Attributes:
        levels: (L, H, W) uint8; level 0 is the likelihood, level h the largest of the
            2^h × 2^h cells that begin at a cell (Olson 2009; Hess et al. 2016).
        x: of the outer corner of cell (0, 0), m.
        y: likewise.
        resolution: edge of a cell, m.
    """

    levels: NDArray[np.uint8]
    x: float
    y: float
    resolution: float


def make_score_grid(points: Points, resolution: float, levels: int) -> ScoreGrid:
    """Return the grid of points (N, 4), N > 0, with ``levels`` levels."""
    margin = (_CUT_CELLS + 1) * resolution
    low = points[:, :2].min(axis=0) - margin
    width, height = np.ceil((points[:, :2].max(axis=0) + margin - low) / resolution)
    grid = np.zeros((levels, int(height), int(width)), np.uint8)
    made = ScoreGrid(grid, float(low[0]), float(low[1]), resolution)
    _rasterise(made, points)
    for level in range(1, levels):
        _pool(grid[level - 1], grid[level], 1 << (level - 1))
    return made


@kernel
def _rasterise(grid: ScoreGrid, points: Points) -> None:
    base = grid.levels[0]
    for i in range(points.shape[0]):
        u = (points[i, 0] - grid.x) / grid.resolution
        v = (points[i, 1] - grid.y) / grid.resolution
        column, row = int(u), int(v)
        for r in range(row - _CUT_CELLS, row + _CUT_CELLS + 1):
            for c in range(column - _CUT_CELLS, column + _CUT_CELLS + 1):
                du, dv = u - (c + 0.5), v - (r + 0.5)
                share = math.exp(
                    -0.5 * (du * du + dv * dv) / (_SIGMA_CELLS * _SIGMA_CELLS)
                )
                value = np.uint8(LARGEST * share)
                if value > base[r, c]:
                    base[r, c] = value


@kernel
def _pool(fine: NDArray[np.uint8], coarse: NDArray[np.uint8], step: int) -> None:
    """Write the largest of the cells at (0, 0), (0, s), (s, 0), (s, s) of ``fine``."""
    height, width = fine.shape
    for r in range(height):
        below = min(r + step, height - 1)
        for c in range(width):
            right = min(c + step, width - 1)
            coarse[r, c] = max(
                max(fine[r, c], fine[r, right]), max(fine[below, c], fine[below, right])
            )
