"""The lethal cells of a map in which beams ended, and where in them."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids.obstacle_points import PART, holds_lethal
from navette.navigation.grids.spec import LETHAL, Cells, GridSpec, grid_frame
from navette.navigation.grids.sub_cells import Masks, Points, points_by_cell
from navette.navigation.grids.windows import CellWindow


class MarkedCells(NamedTuple):
    """Lethal cells with marked points, row by row.

    Attributes:
        cells: (M, 2) row and column.
        middles: (M, 2) mean of the points of each, m, in the grid's frame.
        counts: (M,) number of points of each.
        points: (N, 2) m, in the grid's frame, those of a cell after those before it.
    """

    cells: NDArray[np.int64]
    middles: Points
    counts: NDArray[np.int64]
    points: Points


def marked_cells(
    masks: Masks, spec: GridSpec, cells: Cells, window: CellWindow
) -> MarkedCells:
    """Return the lethal cells with marked points in a window.

    Args:
        masks: (H, W) of :func:`mark_points`.
        spec: its geometry.
        cells: (H, W) −1 unknown, 0 free … 100 lethal.
        window: the cells to search.
    """
    return MarkedCells(*_marked_cells(masks, cells, window, grid_frame(spec)))


@kernel
def _marked_cells(masks: Any, cells: Any, window: CellWindow, frame: Any) -> Any:
    found = _lethal_marked(masks, cells, window)
    count = found.shape[0]
    of_each = np.empty(count, np.uint64)
    for k in range(count):
        of_each[k] = masks[found[k, 0], found[k, 1]]
    points, which = points_by_cell(of_each, found)
    middles, counts = np.zeros((count, 2)), np.zeros(count, np.int64)
    for i in range(points.shape[0]):
        u, v = points[i, 0] * frame.resolution, points[i, 1] * frame.resolution
        x = frame.x + (frame.cos * u - frame.sin * v)
        y = frame.y + (frame.sin * u + frame.cos * v)
        points[i, 0], points[i, 1] = x, y
        k = which[i]
        counts[k] += 1
        middles[k, 0] += x
        middles[k, 1] += y
    for k in range(count):
        middles[k, 0] /= counts[k]
        middles[k, 1] /= counts[k]
    return found, middles, counts, points


@kernel
def _lethal_marked(masks: Any, cells: Any, window: CellWindow) -> Any:
    """Return the lethal cells (M, 2) of a window that have marked points."""
    found = np.empty((1024, 2), np.int64)
    count = 0
    for row in range(window.first_row, window.last_row):
        for first in range(window.first_column, window.last_column, PART):
            line = cells[row, first : min(window.last_column, first + PART)]
            if not holds_lethal(line, LETHAL):
                continue
            if count + PART > found.shape[0]:
                found = np.concatenate((found, np.empty_like(found)))
            for k in range(line.size):
                if line[k] >= LETHAL and masks[row, first + k] != 0:
                    found[count, 0], found[count, 1] = row, first + k
                    count += 1
    return found[:count].copy()
