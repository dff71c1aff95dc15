"""Match of a scan with the key scans around it."""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from navette.geometry import Pose2, wrap_angle
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.motion import inverted
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.point_map import make_point_map
from navette.navigation.slam.refinement import PosePrior, Refined, refine
from navette.navigation.slam.scan_graph import KeyScan, ScanGraph
from navette.navigation.slam.scan_points import LEAST_POINTS, Points
from navette.navigation.slam.score_grid import ScoreGrid, make_score_grid
from navette.navigation.slam.visibility import (
    SensorView,
    Views,
    contradicted_share,
    make_views,
)

SIGMAS = 3.0
"""Standard deviations that a search covers."""

# The refinement converges alone from closer than this share of its radius, and turn.
_NEAR = 0.3
_NEAR_RAD = 0.05
_WIDEST_M = 5.0
# Share of a local map's points that are compared with a scan's free space.
_EVERY = 4
# Fit that a squared Mahalanobis distance of 1 from the prior costs.
_UNLIKELY = 0.01
# Maxima of the score that are refined, and those while none of them fits well: scans of
# places that are far apart share few surfaces, and have several maxima.
_MAXIMA, _MOST_MAXIMA = 3, 12
# Share of the best score that they reach.
_RIVAL = 0.5
DOUBTFUL = 0.6
"""Overlap below which a match is doubted."""
# Fit that a pose far from the prior must gain.
_GAIN = 0.02


class LocalMap:
    """The surfaces around the robot, for search and refinement.

    Args:
        points: (N, 4), N > 0.
        params: radius of correspondence, cell of the search.
        levels: levels of the search grid, for windows of up to 2^levels cells.
        scans: the scans of the points, to find contradictions.
    """

    def __init__(
        self,
        points: Points,
        params: SlamParams,
        levels: int = 4,
        scans: Sequence[SensorView] = (),
    ) -> None:
        self.surface = make_point_map(points, params.match_radius_m)
        self._points = points
        self._resolution_m = params.search_resolution_m
        self._levels = levels
        self._scans = scans

    @cached_property
    def grid(self) -> ScoreGrid:
        """The likelihood of a hit by position; made when a search needs it."""
        return make_score_grid(self._points, self._resolution_m, self._levels)

    @cached_property
    def views(self) -> Views:
        """The free space that the scans have seen."""
        return make_views(self._scans)

    def contradiction(self, placed: SensorView, points: Points, pose: Pose2) -> float:
        """Return the share of points that contradict a scan at ``pose``, 0 to 1.

        Either the scan has surfaces where the map is free, or the reverse.

        Args:
            placed: the scan, with the pose of its sensor on the robot.
            points: (N, 4) of the scan in the base frame.
            pose: of the base in the map's frame.
        """
        if not len(points):
            return 0.0
        new = contradicted_share(self.surface, self.views, points, pose)
        own = make_point_map(points, self.surface.cell_m)
        known = np.ascontiguousarray(self._points[::_EVERY])
        old = contradicted_share(own, make_views([placed]), known, pose.inverse())
        return max(new, old)


class ScanComparison(NamedTuple):
    """A scan at its best pose on a local map.

    Attributes:
        refined: the match; None: the scan does not overlap the map, or contradicts it.
        contradicted: share of its points that contradict the map, 0 to 1.
        is_contradicted: whether these are too many.
    """

    refined: Refined | None
    contradicted: float
    is_contradicted: bool

    @property
    def overlap(self) -> float:
        """Share of points that match, 0 to 1."""
        return 0.0 if self.refined is None else self.refined.overlap


def make_local_map(
    graph: ScanGraph, nodes: Sequence[int], pose: Pose2, params: SlamParams
) -> LocalMap:
    """Return the map of key scans around a pose; nothing matches it without echoes."""
    points = graph.points(nodes)
    if not len(points):
        points = np.array([[pose.x, pose.y, 0.0, 0.0]])
    scans = [
        SensorView(
            graph.keys[node].scan, graph.pose(node) @ graph.keys[node].base_T_sensor
        )
        for node in nodes
    ]
    return LocalMap(points, params, scans=scans)


def match(
    local: LocalMap, points: Points, prior: PosePrior, params: SlamParams
) -> Refined | None:
    """Return the pose of a scan on a local map; None: it does not overlap.

    The search covers three standard deviations of the prior. It is omitted where the
    refinement converges alone.
    """
    if len(points) < LEAST_POINTS:
        return None
    best = _refined(local, points, prior.pose, prior, params)
    covariance = inverted(prior.information)
    spread = SIGMAS * math.sqrt(max(covariance[0, 0], covariance[1, 1]))
    turn = SIGMAS * math.sqrt(covariance[2, 2])
    if spread > _NEAR * params.match_radius_m or turn > _NEAR_RAD:
        window = SearchWindow(min(spread, _WIDEST_M), min(turn, math.pi))
        starts: list[Pose2] = []
        least = 0.0
        for k in range(_MOST_MAXIMA):
            if k >= _MAXIMA and best.overlap >= DOUBTFUL:
                break
            found = search(
                local.grid, points, prior.pose, window,
                min_score=least, excluded=starts,
            )  # fmt: skip
            if found is None:
                break
            least = max(least, _RIVAL * found.score)
            other = _refined(local, points, found.pose, prior, params)
            starts += (found.pose, other.pose)
            if _fit(other, prior, params) > _fit(best, prior, params) + _GAIN:
                best = other
    return best if best.overlap >= params.min_overlap else None


def compare(
    local: LocalMap, key: KeyScan, prior: PosePrior, params: SlamParams
) -> ScanComparison:
    """Match a scan with a local map and count what contradicts the map there."""
    found = match(local, key.points, prior, params)
    pose = prior.pose if found is None else found.pose
    view = SensorView(key.scan, key.base_T_sensor)
    contradicted = local.contradiction(view, key.points, pose)
    is_contradicted = contradicted > params.max_contradicted
    return ScanComparison(
        None if is_contradicted else found, contradicted, is_contradicted
    )


def _refined(
    local: LocalMap, points: Points, start: Pose2, prior: PosePrior, params: SlamParams
) -> Refined:
    return refine(
        local.surface, points, start, noise_m=params.match_noise_m, prior=prior
    )


def _fit(refined: Refined, prior: PosePrior, params: SlamParams) -> float:
    """Return the share of points with a correspondence.

    Less where they are far off, and where the pose is far from the prior.
    """
    away = np.array(refined.pose) - np.array(prior.pose)
    away[2] = wrap_angle(away[2])
    unlikely = float(away @ prior.information @ away)
    return refined.fit(params.match_noise_m) - _UNLIKELY * unlikely
