"""Progress of the robot, measured along its path."""

import math
from typing import Any

import numpy as np

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.planning.path_shape import Poses, lengths, turns

# A radian turned in place counts as this many metres of progress, and a radian of
# heading error as this many metres of distance when searching the nearest pose.
_METRES_PER_RADIAN = 0.5
# Search window ahead of the last pose, so that the search does not skip a loop of a
# path that crosses itself.
_AHEAD_M = 2.0


class PathProgress:
    """Track the robot along one path; progress never decreases.

    In a straight line to the goal, a robot that drives around an obstacle makes no
    progress; along the path it does.
    """

    def __init__(self, poses: Poses) -> None:
        self.poses = np.ascontiguousarray(poses)
        self._metres = np.concatenate([[0.0], np.cumsum(lengths(poses))])
        spun = np.concatenate([[0.0], np.cumsum(turns(poses))])
        self._measure = self._metres + _METRES_PER_RADIAN * spun
        x, y, yaw = poses[-1].tolist()
        self.end = Pose2(x, y, yaw)
        self.index = 0
        self.off_path_m = 0.0

    def update(self, robot: Pose2) -> None:
        """Advance to the pose nearest to the robot."""
        stop = int(
            np.searchsorted(
                self._measure, self._measure[self.index] + _AHEAD_M, "right"
            )
        )
        best, self.off_path_m = _nearest(self.poses[self.index : stop], *robot)
        self.index += best

    @property
    def covered(self) -> float:
        """Metres driven along the path, with turns in place converted to metres."""
        return float(self._measure[self.index])

    @property
    def distance_left_m(self) -> float:
        """Metres of path ahead of the robot."""
        return float(self._metres[-1] - self._metres[self.index])

    @property
    def ahead(self) -> Poses:
        """The path from the robot's pose to the end."""
        return self.poses[self.index :]

    def distance_to_end(self, robot: Pose2) -> float:
        """Return the straight-line distance (m) from the robot to the end."""
        return math.dist((robot.x, robot.y), (self.end.x, self.end.y))


@kernel(signature="Tuple((int64, float64))(float64[:, ::1], float64, float64, float64)")
def _nearest(poses: Any, x: float, y: float, yaw: float) -> tuple[int, float]:
    """Return the index of the pose (N, 3) nearest to a pose, and its distance in m.

    The first of equally near ones, so that a turn in place is not skipped.
    """
    best, least, off_m = 0, np.inf, 0.0
    for k in range(poses.shape[0]):
        away = np.hypot(poses[k, 0] - x, poses[k, 1] - y)
        error = (poses[k, 2] - yaw + np.pi) % (2 * np.pi) - np.pi
        measure = away + _METRES_PER_RADIAN * abs(error)
        if measure < least:
            best, least, off_m = k, measure, away
    return best, off_m
