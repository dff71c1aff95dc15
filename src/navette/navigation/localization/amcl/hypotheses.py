"""Other places that explain what the robot has seen as well as the estimated pose.

Rooms that look alike are not distinguished by one scan. The newest scans, placed
relative to each other by the odometry, are searched for in the whole map together.
"""

import numpy as np

from navette.geometry import Pose2
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

# Motion between two scans that are compared, and how many are.
APART_M, APART_RAD, SCANS = 0.5, 0.5, 4
# Points of all these scans that are used.
MOST_POINTS = 360
# Difference of the mean log likelihood of a beam up to which two places are equally
# likely. That of the true place is at most 0.002 below the best one.
_ALIKE = 0.012


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
