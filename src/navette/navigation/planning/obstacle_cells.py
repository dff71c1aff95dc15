"""Which cells of the map are obstacles, and which of them have changed."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import CellWindow


def update_obstacles(
    obstacles: NDArray[np.uint8],
    occupancy: NDArray[np.int8],
    window: CellWindow,
    lethal_cost: int,
) -> NDArray[np.int64]:
    """Set which cells of a window are obstacles; return those (N, 2) that changed.

    Args:
        obstacles: (H, W) 1 = obstacle, changed in place.
        occupancy: (H, W) −1 unknown, 0 free … 100 occupied.
        window: the cells to set.
        lethal_cost: occupancy from which a cell is an obstacle.
    """
    changed: NDArray[np.int64] = _update(
        obstacles, occupancy, window, np.int8(lethal_cost)
    )
    return changed


@kernel
def _update(obstacles: Any, occupancy: Any, window: Any, lethal: Any) -> Any:
    changed = np.empty((256, 2), np.int64)
    count = 0
    first, width = window.first_column, window.last_column - window.first_column
    for row in range(window.first_row, window.last_row):
        now = occupancy[row, first : first + width]
        line = obstacles[row, first : first + width]
        if not _differ(now, line, lethal):
            continue
        if count + width > changed.shape[0]:
            changed = _longer(changed, width)
        for k in range(width):
            is_obstacle = np.uint8(now[k] >= lethal)
            if is_obstacle != line[k]:
                line[k] = is_obstacle
                changed[count, 0], changed[count, 1] = row, first + k
                count += 1
    return changed[:count].copy()


@kernel
def _longer(cells: Any, more: int) -> Any:
    longer = np.empty((2 * cells.shape[0] + more, 2), np.int64)
    longer[: cells.shape[0]] = cells
    return longer


@kernel(allocates=False)
def _differ(now: Any, line: Any, lethal: Any) -> bool:
    differ = False  # vectorised: most rows are as before
    for k in range(now.size):
        differ |= (now[k] >= lethal) != (line[k] != 0)
    return differ
