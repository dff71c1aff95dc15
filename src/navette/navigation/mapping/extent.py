"""Extent of the map and its growth."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import CellWindow, GridSpec
from navette.navigation.mapping.params import MapMemoryParams


@dataclass(frozen=True)
class Growth:
    """An enlarged extent and the cells added on each side."""

    spec: GridSpec
    rows: tuple[int, int]
    columns: tuple[int, int]


def known_corners(
    cells: NDArray[np.int8], spec: GridSpec
) -> NDArray[np.float64] | None:
    """Return corners (4, 2), m, of the box around the known cells, if any."""
    known = CellWindow.of_known(cells)
    if known.is_empty:
        return None
    u = np.array([known.first_column, known.last_column]) * spec.resolution
    v = np.array([known.first_row, known.last_row]) * spec.resolution
    return spec.origin.apply(np.array([(x, y) for x in u for y in v]))


def grow_to_hold(
    spec: GridSpec, points: NDArray[np.float64], params: MapMemoryParams
) -> Growth | None:
    """Enlarge the map's extent until it holds ``points``; None: not needed, or in vain.

    Grows on the required sides by multiples of ``growth_m`` while an edge stays within
    ``max_size_m``; points beyond that stay outside. A loaded map with smaller cells
    gets no more of them than a map with ``resolution_m``: they need the memory.

    Args:
        spec: the present extent.
        points: (N, 2) in the map frame, m.
        params: growth and limit.
    """
    local = spec.origin.inverse().apply(points) / spec.resolution
    step = max(1, round(params.growth_m / spec.resolution))
    cell_m = max(spec.resolution, params.resolution_m)
    most = math.floor(params.max_size_m / cell_m + 1e-9)
    columns = _sides(local[:, 0], spec.width, step, most)
    rows = _sides(local[:, 1], spec.height, step, most)
    if columns == (0, 0) and rows == (0, 0):
        return None
    added = np.array([columns, rows])
    low, high = -added[:, 0], (spec.width, spec.height) + added[:, 1]
    if (local.max(axis=0) <= low).any() or (local.min(axis=0) >= high).any():
        return None  # all points would stay outside
    shift = Pose2(-columns[0] * spec.resolution, -rows[0] * spec.resolution, 0.0)
    larger = GridSpec(
        spec.resolution,
        spec.width + sum(columns),
        spec.height + sum(rows),
        spec.origin @ shift,
    )
    return Growth(larger, rows, columns)


def _sides(at: NDArray[np.float64], size: int, step: int, most: int) -> tuple[int, int]:
    """Return the cells to add before and after an axis of ``size`` cells."""
    # A point on the border, up to rounding, needs no growth.
    room = most - size
    # Limit the chunks first: a far point may require billions.
    chunks = max(0, math.ceil(room / step))
    before = step * min(chunks, max(0, math.ceil(-(at.min() + 1e-6) / step)))
    after = step * min(chunks, max(0, math.ceil((at.max() - size - 1e-6) / step)))
    while before + after > room and (before or after):
        if before >= after:
            before -= step
        else:
            after -= step
    return before, after
