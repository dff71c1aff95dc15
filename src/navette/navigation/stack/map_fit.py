"""Whether a given map is in the frame of the simulated world."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.grids.distance import distance_field
from navette.navigation.grids.spec import Cells
from navette.navigation.worlds.shortest import filled_outlines

_OCCUPIED = 65  # map_server's value from which a cell is an obstacle
_NEAR_M = 0.25
# A map of the world has about 1, with all furniture moved 0.88; one of regular rooms,
# moved by a room, 0.7.
_LEAST_SHARE = 0.8


def fits_world(
    cells: Cells, spec: GridSpec, outlines: Sequence[NDArray[np.float64]]
) -> bool:
    """Return whether the map's obstacles are obstacles of the world, in its frame.

    Four of five occupied cells must lie in or beside an obstacle: the others may be of
    furniture that was moved. Obstacles that the map lacks do not count, because a map
    may cover a part of the world.

    Args:
        cells: (H, W) -1 unknown, 0 free … 100 occupied.
        spec: their geometry.
        outlines: of the world's obstacles, convex, counter-clockwise (N, 2), m.
    """
    occupied = cells >= _OCCUPIED
    if not occupied.any():
        return False
    grid_T_world = spec.origin.inverse()
    upright = GridSpec(spec.resolution, spec.width, spec.height, Pose2(0.0, 0.0, 0.0))
    world = filled_outlines([grid_T_world.apply(each) for each in outlines], upright)
    near_m = max(_NEAR_M, 1.5 * spec.resolution)
    away = distance_field(world, spec.resolution, near_m + spec.resolution)
    return bool((away[occupied] <= near_m).mean() >= _LEAST_SHARE)
