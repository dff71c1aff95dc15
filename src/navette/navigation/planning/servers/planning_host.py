"""Interface of the node ``planner`` to its servers."""

from typing import Protocol

import numpy as np

from navette.geometry import Pose2
from navette.msgs.nav_msgs.msg import Path
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.path_shape import Poses
from navette.navigation.planning.planner import Planner
from navette.runtime.input_check import FARTHEST
from navette.runtime.stage.path_messages import moved, poses_of
from navette.runtime.worker import Worker


class PlanningHost(Protocol):
    """The node with the newest map and pose."""

    @property
    def params(self) -> PlannerParams:
        """The present parameters."""

    @property
    def worker(self) -> Worker:
        """Computes paths beside the node's callbacks."""

    def planner_with_map(self) -> Planner | None:
        """Return the planner on the newest map; None before the first."""

    def fresh_pose(self) -> Pose2 | None:
        """Return the pose of the robot; None if unknown or stale."""

    def frame_on_map(self, frame_id: str) -> Pose2 | None:
        """Return the pose of a frame in the map frame; None if unknown."""

    def publish_plan(self, path: Path) -> None:
        """Publish a planned path, which is not followed."""


def path_on_map(host: PlanningHost, msg: Path) -> Poses | None:
    """Return the poses (N, 3) of a path in the map frame.

    None: the frame is unknown, or a value is not finite or out of range.
    """
    map_T_frame = host.frame_on_map(msg.header.frame_id or host.params.map_frame)
    poses = poses_of(msg)
    if map_T_frame is None or not (np.abs(poses) <= FARTHEST).all():
        return None
    return moved(poses, map_T_frame)
