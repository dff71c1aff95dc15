"""Costs as Nav2's costmaps store them (0 … 255), from those of an occupancy grid."""

import numpy as np
from numpy.typing import NDArray

from navette.msgs.nav2_msgs.msg import Costmap, CostmapMetaData
from navette.msgs.nav_msgs.msg import OccupancyGrid

# nav2_costmap_2d: 0 free, 253 inscribed, 254 lethal, 255 unknown; published as 0, 99,
# 100 and -1. 1 … 252 are published as 1 + 97 (c - 1) // 251, of which this is the
# inverse.
_TABLE = np.zeros(102, np.uint8)
_TABLE[2:100] = 1 - (-np.arange(98) * 251 // 97)
_TABLE[[0, 100, 101]] = 255, 253, 254


def costmap_values(cells: NDArray[np.int8]) -> NDArray[np.uint8]:
    """Return Nav2's costs of occupancies (−1 unknown, 0 free … 100 lethal)."""
    return np.asarray(_TABLE[np.clip(cells, -1, 100).astype(np.int16) + 1])


def costmap_message(grid: OccupancyGrid) -> Costmap:
    """Return an occupancy grid as ``nav2_msgs/msg/Costmap``."""
    info = grid.info
    return Costmap(
        header=grid.header,
        metadata=CostmapMetaData(
            map_load_time=info.map_load_time,
            update_time=grid.header.stamp,
            layer="master",
            resolution=info.resolution,
            size_x=info.width,
            size_y=info.height,
            origin=info.origin,
        ),
        data=costmap_values(np.asarray(grid.data)),
    )
