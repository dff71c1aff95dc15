"""From a costmap to the obstacle points around the robot."""

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.grids import GridSpec


def obstacle_points(
    cost: NDArray[np.int8],
    spec: GridSpec,
    map_T_grid: Pose2,
    *,
    lethal: int,
    around: Pose2,
    reach: float,
) -> NDArray[np.float64]:
    """Centres (N, 2), metres, map, of the lethal cells in a square around a pose.

    Args:
        cost: (H, W), or flat in that order; 0 … 100, −1 unknown. Unknown cells
            are no obstacles here: behind every hit the grid is unknown, and the
            body's own place may be as well.
        spec: geometry of ``cost`` in its frame.
        map_T_grid: pose of that frame in the map at the costmap's stamp.
        lethal: value from which a cell counts.
        around: pose (map) in whose surroundings obstacles matter.
        reach: half the edge of the square, metres.

    Raises:
        InvalidValueError: ``cost`` has not as many cells as ``spec`` says.
    """
    if cost.size != spec.width * spec.height:
        raise InvalidValueError(
            f"costmap of {cost.size} cells: wanted {spec.width} x {spec.height}"
        )
    cost = cost.reshape(spec.shape)
    grid_T_around = map_T_grid.inverse() @ around
    row, column = spec.cell_of(grid_T_around.x, grid_T_around.y)
    half = int(reach / spec.resolution) + 1
    top, left = max(0, row - half), max(0, column - half)
    window = cost[top : max(0, row + half + 1), left : max(0, column + half + 1)]
    cells = np.argwhere(window >= lethal)
    if not len(cells):
        return np.empty((0, 2))
    return map_T_grid.apply(spec.centers_of(cells + np.array([top, left])))
