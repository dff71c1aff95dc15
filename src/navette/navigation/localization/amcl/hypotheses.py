"""Other places that explain what the robot has seen as well as the estimated pose.

Rooms that look alike are not distinguished by one scan. The newest scans, placed
relative to each other by the odometry, are searched for in the whole map together.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from navette.geometry import Pose2, angle_difference
from navette.navigation.localization.amcl.global_search import (
    Candidates,
    different,
    search_map,
)
from navette.navigation.localization.amcl.likelihood_field import (
    LikelihoodField,
    Points,
    Poses,
)

# Motion between two scans that are kept, and how many are.
_APART_M, _APART_RAD = 0.5, 0.5
_KEPT = 4
# Points of all kept scans that are compared.
_MOST_POINTS = 360
# Difference of the mean log likelihood of a beam up to which two places are equally
# likely. That of the true place is at most 0.002 below the best one.
_ALIKE = 0.012


class _Seen(NamedTuple):
    points: Points
    odom_T_base: Pose2


class RecentScans:
    """Scans along the path, the newest ones."""

    def __init__(self) -> None:
        self._kept: deque[_Seen] = deque(maxlen=_KEPT)

    def clear(self) -> None:
        """Forget all scans."""
        self._kept.clear()

    def add(self, points: Points, odom_T_base: Pose2) -> None:
        """Keep the ends of beams (N, 2), base frame, if the robot has moved."""
        if self._kept:
            before = self._kept[-1].odom_T_base
            turned = abs(angle_difference(before.yaw, odom_T_base.yaw))
            if before.distance_to(odom_T_base) < _APART_M and turned < _APART_RAD:
                return
        self._kept.append(_Seen(points, odom_T_base))

    def move_odometry(self, new_T_old: Pose2) -> None:
        """Place the scans in the odometry's frame after a jump."""
        kept = [_Seen(each.points, new_T_old @ each.odom_T_base) for each in self._kept]
        self._kept.clear()
        self._kept.extend(kept)

    def seen_from(self, points: Points, odom_T_base: Pose2) -> Points:
        """Return the points of the kept scans and of this one in its base frame."""
        base_T_odom = odom_T_base.inverse()
        parts = [
            (base_T_odom @ each.odom_T_base).apply(each.points) for each in self._kept
        ]
        together = np.concatenate([points, *parts])
        step = -(-len(together) // _MOST_POINTS)
        return np.ascontiguousarray(together[::step])


def hypotheses(field: LikelihoodField, points: Points, pose: Pose2) -> Candidates:
    """Return the poses that explain the points as well as the best one does.

    Args:
        field: of the map.
        points: (N, 2) of one or several scans, base frame, m.
        pose: the estimated pose, which competes with those of the whole map.
    """
    found = search_map(field, points)
    own, _ = field.refined(np.array([pose]), points, 0.1, 0.05)
    poses: Poses = np.concatenate([own, found.poses])
    # Within a cell of an obstacle a beam hits it: where the cells' edges lie relative
    # to the walls differs between places that are alike.
    scores = field.tolerant.scores(poses, points)
    order = np.argsort(-scores, kind="stable")
    order = order[scores[order] >= scores.max() - _ALIKE]
    chosen = order[different(poses[order], len(order))]
    return Candidates(poses[chosen], scores[chosen])
