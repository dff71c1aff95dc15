"""Finer map for doors that are too narrow for the resolution of the map.

A lethal cell of 0.1 m may cover half of the clearance on each side of a door. The finer
map has lethal cells only where beams ended, so that a search on it resolves
centimetres. The finer map is large; it is used only where no path exists on the map.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import FREE, LETHAL, GridSpec, mark_points

_RESOLUTION_M = 0.025
_MOST_CELLS = 6_000_000


class CloseMap(NamedTuple):
    """Occupancy (H, W) in finer cells, and their geometry in the map frame."""

    occupancy: NDArray[np.int8]
    spec: GridSpec


def close_map(
    occupancy: NDArray[np.int8],
    spec: GridSpec,
    hits: NDArray[np.float64],
    lethal_cost: int,
    around: NDArray[np.float64],
    reach_m: float,
) -> CloseMap:
    """Return the relevant part of a map in cells of about 2.5 cm.

    Args:
        occupancy: (H, W) −1 unknown, 0 free … 100 occupied.
        spec: its geometry.
        hits: (N, 2) map frame, m: where beams ended within its lethal cells.
        lethal_cost: value from which a cell is an obstacle.
        around: (M, 2) map frame, m: points that the part contains.
        reach_m: distance from obstacles up to which the part contains the map.
    """
    lethal = occupancy >= lethal_cost
    rows, columns = _part(lethal, spec, around, reach_m)
    coarse = GridSpec(
        spec.resolution,
        columns.stop - columns.start,
        rows.stop - rows.start,
        spec.origin
        @ Pose2(columns.start * spec.resolution, rows.start * spec.resolution, 0.0),
    )
    largest = math.isqrt(_MOST_CELLS // (coarse.width * coarse.height))
    factor = max(1, min(round(spec.resolution / _RESOLUTION_M), largest))
    fine = GridSpec(
        spec.resolution / factor,
        coarse.width * factor,
        coarse.height * factor,
        coarse.origin,
    )
    cells, lethal = occupancy[rows, columns].copy(), lethal[rows, columns]
    masks = np.zeros(coarse.shape, np.uint64)
    measured = np.zeros(coarse.shape, np.bool_)
    measured[tuple(mark_points(masks, coarse, hits).T)] = True
    cells[lethal & measured] = FREE
    closer = np.repeat(np.repeat(cells, factor, axis=0), factor, axis=1)
    marked = mark_points(np.zeros(fine.shape, np.uint64), fine, hits)
    closer[tuple(marked.T)] = LETHAL
    return CloseMap(closer, fine)


def _part(
    lethal: NDArray[np.bool_],
    spec: GridSpec,
    around: NDArray[np.float64],
    reach_m: float,
) -> tuple[slice, slice]:
    """Return the rows and columns that contain the points and the obstacles."""
    cells = np.array([spec.cell_of(x, y) for x, y in around.tolist()])
    found = [cells]
    if lethal.any():
        rows, columns = (np.flatnonzero(lethal.any(axis=axis)) for axis in (1, 0))
        found.append(np.array([(rows[0], columns[0]), (rows[-1], columns[-1])]))
    reach = math.ceil(reach_m / spec.resolution)
    low = np.maximum(np.concatenate(found).min(axis=0) - reach, 0)
    high = np.minimum(np.concatenate(found).max(axis=0) + reach + 1, spec.shape)
    return slice(int(low[0]), int(high[0])), slice(int(low[1]), int(high[1]))
