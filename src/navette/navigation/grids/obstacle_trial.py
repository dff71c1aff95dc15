"""A trial that loads or compiles the kernels that place obstacles, before they matter.

A robot that drives would wait for them between two commands.
"""

import numpy as np

from navette.geometry import Footprint, Pose2
from navette.navigation.grids.hit_points import points_to_message
from navette.navigation.grids.messages import grid_to_message
from navette.navigation.grids.obstacles import ObstacleTracker
from navette.navigation.grids.received_map import ReceivedMap
from navette.navigation.grids.spec import FREE, LETHAL, UNKNOWN, GridSpec

_MAP = "map"
_HERE = Pose2(0.0, 0.0, 0.0)


class _Standing:
    """The poses of a robot that stands at the origin of the map."""

    map_frame = _MAP
    first = _HERE

    def predicted_at(self, stamp_ns: int) -> Pose2:
        return _HERE

    def predicted_now(self, now_ns: int) -> Pose2:
        return _HERE

    def transform_to_base(self, frame_id: str) -> Pose2:
        return _HERE


def load_obstacle_kernels(footprint: Footprint) -> None:
    """Place the obstacles of a map and of a costmap of four cells."""
    cells = np.array([[LETHAL, FREE], [FREE, UNKNOWN]], np.int8)
    spec = GridSpec(0.05, 2, 2)
    grid = grid_to_message(cells, spec, _MAP, 0)
    known = ReceivedMap(cells, spec)
    points = points_to_message(np.array([(0.02, 0.02)]), _MAP, 0)
    trial = ObstacleTracker(_Standing(), footprint, hand_m=0.0)
    trial.remember_points(points)
    trial.receive_points(points)
    for _ in range(2):  # the second map is compared with the first
        trial.remember(known, None, 0, 0, LETHAL)
    trial.receive(grid, 0)
    trial.place(0, LETHAL, reach_m=1.0, unseen_reach_m=1.0)
