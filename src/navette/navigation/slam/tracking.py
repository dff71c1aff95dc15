"""Match of a scan with the key scans around it."""

import math
from functools import cached_property

from navette.geometry import Pose2
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.motion import inverted
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.point_map import make_point_map
from navette.navigation.slam.refinement import PosePrior, Refined, refine
from navette.navigation.slam.scan_points import Points
from navette.navigation.slam.score_grid import ScoreGrid, make_score_grid

SIGMAS = 3.0
"""Standard deviations that a search covers."""

# The refinement converges alone from closer than this share of its radius, and turn.
_NEAR = 0.3
_NEAR_RAD = 0.05
_WIDEST_M = 5.0
_LEAST_POINTS = 10


class LocalMap:
    """The surfaces around the robot, for search and refinement.

    Args:
        points: (N, 4), N > 0.
        params: radius of correspondence, cell of the search.
        levels: levels of the search grid, for windows of up to 2^levels cells.
    """

    def __init__(self, points: Points, params: SlamParams, levels: int = 4) -> None:
        self.surface = make_point_map(points, params.match_radius_m)
        self._points = points
        self._resolution_m = params.search_resolution_m
        self._levels = levels

    @cached_property
    def grid(self) -> ScoreGrid:
        """The likelihood of a hit by position; made when a search needs it."""
        return make_score_grid(self._points, self._resolution_m, self._levels)


def match(
    local: LocalMap, points: Points, prior: PosePrior, params: SlamParams
) -> Refined | None:
    """Return the pose of a scan on a local map; None: it does not overlap.

    The search covers three standard deviations of the prior. It is omitted where the
    refinement converges alone.
    """
    if len(points) < _LEAST_POINTS:
        return None
    covariance = inverted(prior.information)
    spread = SIGMAS * math.sqrt(max(covariance[0, 0], covariance[1, 1]))
    turn = SIGMAS * math.sqrt(covariance[2, 2])
    start: Pose2 = prior.pose
    if spread > _NEAR * params.match_radius_m or turn > _NEAR_RAD:
        window = SearchWindow(min(spread, _WIDEST_M), min(turn, math.pi))
        found = search(local.grid, points, prior.pose, window)
        if found is not None:
            start = found.pose
    refined = refine(
        local.surface, points, start, noise_m=params.match_noise_m, prior=prior
    )
    return refined if refined.overlap >= params.min_overlap else None
