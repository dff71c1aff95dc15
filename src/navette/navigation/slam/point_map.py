"""Points in square cells, for the search of neighbours."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.slam.scan_points import Points


class PointMap(NamedTuple):
    """Points sorted by cell.

    Attributes:
        points: (N, 4) by cell.
        starts: (H · W + 1,) index of the first point of each cell.
        shape: (H, W).
        x: of the outer corner of cell (0, 0), m.
        y: likewise.
        cell_m: edge of a cell; neighbours within it lie in the 3 × 3 cells around.
    """

    points: Points
    starts: NDArray[np.int32]
    shape: tuple[int, int]
    x: float
    y: float
    cell_m: float


def make_point_map(points: Points, cell_m: float) -> PointMap:
    """Return the map of points (N, 4), N > 0."""
    low = points[:, :2].min(axis=0)
    width, height = ((points[:, :2].max(axis=0) - low) // cell_m).astype(int) + 1
    starts = np.zeros(int(height) * int(width) + 1, np.int32)
    ordered = np.empty_like(points)
    shape = (int(height), int(width))
    made = PointMap(ordered, starts, shape, float(low[0]), float(low[1]), cell_m)
    _sort_kernel(made, points)
    return made


@kernel
def _sort_kernel(made: PointMap, points: Points) -> None:
    """Sort the points by cell (counting sort)."""
    width = made.shape[1]
    cells = np.empty(points.shape[0], np.int64)
    for i in range(points.shape[0]):
        column = int((points[i, 0] - made.x) / made.cell_m)
        row = int((points[i, 1] - made.y) / made.cell_m)
        cells[i] = min(row, made.shape[0] - 1) * width + min(column, width - 1)
        made.starts[cells[i] + 1] += 1
    for k in range(made.starts.size - 1):
        made.starts[k + 1] += made.starts[k]
    place = made.starts[:-1].copy()
    for i in range(points.shape[0]):
        made.points[place[cells[i]]] = points[i]
        place[cells[i]] += 1
