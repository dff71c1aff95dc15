"""The path that the robot has driven lately."""

import math
from collections import deque

from navette.geometry import Pose2

_SPACING_M = 0.05
_KEPT_M = 5.0


class DrivenTrail:
    """Poses of the robot's base, a few centimetres apart, over the last metres."""

    def __init__(self) -> None:
        self._poses: deque[Pose2] = deque(maxlen=round(_KEPT_M / _SPACING_M))

    def add(self, pose: Pose2) -> None:
        """Note a pose; a jump starts the trail again."""
        if self._poses:
            moved = math.dist((pose.x, pose.y), (self._poses[-1].x, self._poses[-1].y))
            if moved < _SPACING_M:
                return
            if moved > 20 * _SPACING_M:
                self._poses.clear()
        self._poses.append(pose)

    def back(self, here: Pose2, distance_m: float) -> list[Pose2]:
        """Return poses from here back along the trail; headings as driven.

        The headings point against the direction of travel: the robot drives it in
        reverse where it came forward.
        """
        poses, length = [here], 0.0
        for pose in reversed(self._poses):
            step = math.dist((pose.x, pose.y), (poses[-1].x, poses[-1].y))
            if step < _SPACING_M / 2:
                continue
            poses.append(pose)
            length += step
            if length >= distance_m:
                break
        return poses if len(poses) > 1 else []

    def clear(self) -> None:
        self._poses.clear()
