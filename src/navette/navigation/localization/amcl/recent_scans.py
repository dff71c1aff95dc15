"""Scans along the path, placed relative to each other by the odometry."""

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from navette.geometry import Pose2, angle_difference
from navette.navigation.localization.amcl.likelihood_field import Points


class Seen(NamedTuple):
    """A scan, and where it was taken.

    Attributes:
        points: (N, 2) ends of the beams, base frame, m.
        odom_T_base: pose of the base in the odometry's frame.
    """

    points: Points
    odom_T_base: Pose2


class RecentScans:
    """Scans along the path, the newest ones.

    Args:
        most: scans that are kept.
        apart_m: motion between two of them, m …
        apart_rad: … or rotation, rad; infinite if rotations do not count.
    """

    def __init__(self, most: int, apart_m: float, apart_rad: float = math.inf) -> None:
        self._apart = apart_m, apart_rad
        self._kept: deque[Seen] = deque(maxlen=most)

    def clear(self) -> None:
        """Forget all scans."""
        self._kept.clear()

    def add(self, points: Points, odom_T_base: Pose2) -> None:
        """Keep the ends of beams (N, 2), base frame, if the robot has moved."""
        if self._kept and not self._is_apart(self._kept[-1].odom_T_base, odom_T_base):
            return
        self._kept.append(Seen(points, odom_T_base))

    def move_odometry(self, new_T_old: Pose2) -> None:
        """Place the scans in the odometry's frame after a jump."""
        kept = [Seen(each.points, new_T_old @ each.odom_T_base) for each in self._kept]
        self._kept.clear()
        self._kept.extend(kept)

    def seen_from(self, points: Points, odom_T_base: Pose2, most: int) -> Points:
        """Return the points of the kept scans and of this one in its base frame.

        Args:
            points: (N, 2) of this scan, base frame, m.
            odom_T_base: where it was taken.
            most: points that are returned.
        """
        base_T_odom = odom_T_base.inverse()
        parts = [
            (base_T_odom @ each.odom_T_base).apply(each.points) for each in self._kept
        ]
        together = np.concatenate([points, *parts])
        step = -(-len(together) // most)
        return np.ascontiguousarray(together[::step])

    def backward_from(self, points: Points, odom_T_base: Pose2) -> list[Seen]:
        """Return this scan and the kept ones that are apart, newest first.

        Each is apart from all newer ones: a place that is visited twice counts once.
        """
        found = [Seen(points, odom_T_base)]
        for each in reversed(self._kept):
            if all(self._is_apart(each.odom_T_base, one.odom_T_base) for one in found):
                found.append(each)
        return found

    def _is_apart(self, one: Pose2, other: Pose2) -> bool:
        apart_m, apart_rad = self._apart
        turned = abs(angle_difference(one.yaw, other.yaw))
        return one.distance_to(other) >= apart_m or turned >= apart_rad


def thinned(points: Points, count: int) -> Points:
    """Return at most ``count`` of the points, in equal steps of the scan."""
    if len(points) <= count:
        return points
    return points[np.linspace(0, len(points) - 1, count).round().astype(np.int64)]
