"""The path that the robot has driven lately."""

import math
from collections import deque

from navette.geometry import Pose2, angle_difference

_SPACING_M = 0.05
_KEPT_M = 5.0
# Heading error up to which a pose counts as backing up along the trail.
_BACK_RAD = 1.0


class DrivenTrail:
    """Poses of the robot's base, a few centimetres apart, over the last metres."""

    def __init__(self) -> None:
        self._poses: deque[Pose2] = deque(maxlen=round(_KEPT_M / _SPACING_M))

    def add(self, pose: Pose2) -> None:
        """Append a pose; a jump starts a new trail.

        Backing up along the trail removes its end, so that the path back does not first
        lead forward again.
        """
        while self._has_backed_up(pose):
            self._poses.pop()
        if self._poses:
            moved = self._poses[-1].distance_to(pose)
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

    def _has_backed_up(self, pose: Pose2) -> bool:
        """Return whether a pose is nearer to the last but one than the last is."""
        if len(self._poses) < 2:
            return False
        before, last = self._poses[-2], self._poses[-1]
        turned = abs(angle_difference(pose.yaw, before.yaw))
        nearer = before.distance_to(pose) < before.distance_to(last)
        return nearer and turned < _BACK_RAD

    def clear(self) -> None:
        self._poses.clear()
