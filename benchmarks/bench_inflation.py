"""Inflation of a map by 20 cells, compared with OpenCV and SciPy.

Peers compute the exact distance to the nearest lethal cell and look the cost up;
OpenCV's precise transform is the one that matches.
"""

import cv2
import numpy as np
from harness import Benchmark
from scipy.ndimage import distance_transform_edt

from navette.navigation.grids import LETHAL, cost_table, inflate

CELLS = 20
TABLE = cost_table("linear", inflation_radius_m=1.0, resolution=1.0 / CELLS)


def some_map(size: int, seed: int = 0) -> np.ndarray:
    """Walls and posts: 1 to 2 % of the cells lethal, some unknown."""
    rng = np.random.default_rng(seed)
    cost = np.where(rng.random((size, size)) < 0.1, -1, 0).astype(np.int8)
    for _ in range(size // 8):
        row, column = rng.integers(0, size, 2)
        length = rng.integers(1, 40)
        if rng.random() < 0.5:
            cost[row, column : column + length] = LETHAL
        else:
            cost[row : row + length, column] = LETHAL
    return cost


def raised(cost: np.ndarray, distance: np.ndarray) -> np.ndarray:
    """Return the cost by distance (cells), which only raises a cell."""
    d2 = np.minimum(np.rint(distance * distance), TABLE.size - 1).astype(np.intp)
    return np.maximum(cost, TABLE[d2])


def with_opencv(cost: np.ndarray) -> np.ndarray:
    free = (cost < LETHAL).view(np.uint8)
    return raised(cost, cv2.distanceTransform(free, cv2.DIST_L2, cv2.DIST_MASK_PRECISE))


def with_scipy(cost: np.ndarray) -> np.ndarray:
    return raised(cost, distance_transform_edt(cost < LETHAL))


def main() -> None:
    cv2.setNumThreads(1)
    bench = Benchmark("inflation", __doc__)
    for size, target_ms in ((200, 0.18), (400, 0.6), (1000, 6.4)):
        cost = some_map(size)
        ours = inflate(cost, TABLE)
        for peer in (with_opencv, with_scipy):
            np.testing.assert_array_equal(ours, peer(cost))
        bench.case(
            f"{size}², 20 cells",
            {
                "navette": lambda cost=cost: inflate(cost, TABLE),
                "opencv": lambda cost=cost: with_opencv(cost),
                "scipy": lambda cost=cost: with_scipy(cost),
            },
            "all three results are equal",
            target_ms=target_ms,
        )
    bench.main()


if __name__ == "__main__":
    main()
