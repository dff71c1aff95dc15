"""Evidence for another place of the map than the tracked pose, along the path.

One view proves little: where furniture was moved, a room elsewhere often fits the
newest scan better than the right one. The scans of a stretch of driving are compared
from both places. Let s(k) and t(k) be the mean log likelihoods of a beam of scan k,
newest first, seen from the other place and from the tracked pose, both moved backward
by the odometry and refined. The evidence is

    max over n of  sum over k < n of  s(k) - t(k) - a:

the robot may have been at the other place for the last n scans only, carried there
before. The allowance a is what moved furniture explains (a CUSUM test, Page 1954).
A place that explains every scan of a stretch, where the tracked pose does not, needs
less: no wrong place does so where furniture was moved, and rooms that look alike differ
by little.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.localization.amcl.global_search import (
    Candidates,
    is_same,
    search_map,
)
from navette.navigation.localization.amcl.likelihood_field import (
    LikelihoodField,
    Poses,
)
from navette.navigation.localization.amcl.recent_scans import Seen

# Distance between two scans that are compared, and how many are.
PATH_APART_M, PATH_SCANS = 0.5, 20
# Difference per scan that moved furniture explains: in a building of equal rooms it was
# 0.15 on average over 10 m for a room 8 m away. That of a carried robot is about 1.3.
_ALLOWED = 0.3
# Evidence from which another place replaces the tracked pose, and from which it is
# reported. Moved furniture gave a wrong place at most 0.6; the place of a carried robot
# has 2 after 1.0 m of driving (median), in nine of ten cases after 1.5 m.
DECISIVE, NOTABLE = 2.0, 0.5
# Mean log likelihood of a beam from which a scan is explained: that of a right pose is
# about -0.03, with a third of the beams at unknown things -0.7.
GOOD_FIT = -0.1
# Scans that a place must explain without exception, and by how much better on average.
_EXPLAINED_SCANS, _BETTER_FIT = 4, 0.1


def rivals(field: LikelihoodField, scans: Sequence[Seen], tracked: Pose2) -> Candidates:
    """Return the other places of the map with notable evidence, the best one first.

    Args:
        field: of the map.
        scans: along the path, the newest first.
        tracked: pose of the base at the newest one, in the map.

    Returns:
        Poses of the base at the newest scan, with their evidence as scores.
    """
    found = search_map(field, scans[0].points)
    others = found.poses[~is_same(found.poses, tracked)]
    evidence = advantages(field, scans, tracked, others)
    order = np.argsort(-evidence, kind="stable")
    order = order[evidence[order] >= NOTABLE]
    return Candidates(others[order], evidence[order])


def advantages(
    field: LikelihoodField, scans: Sequence[Seen], tracked: Pose2, others: Poses
) -> NDArray[np.float64]:
    """Return the evidence (N,) for each of other poses (N, 3) of the newest scan."""
    own = list(_fits(field, scans, tracked))
    return np.array(
        [
            _largest_sum(own, _fits(field, scans, Pose2(*pose)))
            for pose in others.tolist()
        ]
    )


def _largest_sum(own: Sequence[float], other: Iterator[float]) -> float:
    better = largest = 0.0
    explains_all = True
    for number, (here, there) in enumerate(zip(own, other, strict=True), 1):
        better += there - here
        evidence = better - _ALLOWED * number
        largest = max(largest, evidence)
        explains_all &= there > GOOD_FIT
        is_long = number >= _EXPLAINED_SCANS
        if explains_all and is_long and better > _BETTER_FIT * number:
            largest = max(largest, DECISIVE)
        if better < -DECISIVE:  # most places fit nothing but the newest scan
            break
    return largest


def _fits(
    field: LikelihoodField, scans: Sequence[Seen], pose: Pose2
) -> Iterator[float]:
    """Yield the mean log likelihood of a beam of each scan, the newest first.

    Within a cell of an obstacle a beam hits it, as in the comparison of all places.
    """
    odom_T_base = scans[0].odom_T_base
    for seen in scans:
        pose = pose @ (odom_T_base.inverse() @ seen.odom_T_base)
        odom_T_base = seen.odom_T_base
        refined, _ = field.refined(np.array([pose]), seen.points, 0.1, 0.05)
        pose = Pose2(*refined[0].tolist())
        yield float(field.tolerant.scores(refined, seen.points)[0])
