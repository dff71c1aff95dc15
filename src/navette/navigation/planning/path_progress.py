"""Progress of the robot, measured along its path."""

import math

import numpy as np

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
        self.poses = poses
        self._metres = np.concatenate([[0.0], np.cumsum(lengths(poses))])
        spun = np.concatenate([[0.0], np.cumsum(turns(poses))])
        self._measure = self._metres + _METRES_PER_RADIAN * spun
        self.index = 0
        self.off_path_m = 0.0

    def update(self, robot: Pose2) -> None:
        """Advance to the pose nearest to the robot."""
        stop = int(
            np.searchsorted(
                self._measure, self._measure[self.index] + _AHEAD_M, "right"
            )
        )
        window = self.poses[self.index : stop]
        away = np.hypot(window[:, 0] - robot.x, window[:, 1] - robot.y)
        error = np.remainder(window[:, 2] - robot.yaw + np.pi, 2 * np.pi) - np.pi
        # The first of equally near poses, so that a turn in place is not skipped.
        best = int(np.argmin(away + _METRES_PER_RADIAN * np.abs(error)))
        self.index += best
        self.off_path_m = float(away[best])

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

    @property
    def end(self) -> Pose2:
        """The last pose."""
        x, y, yaw = self.poses[-1].tolist()
        return Pose2(x, y, yaw)

    def distance_to_end(self, robot: Pose2) -> float:
        """Return the straight-line distance (m) from the robot to the end."""
        return math.dist((robot.x, robot.y), (self.end.x, self.end.y))
