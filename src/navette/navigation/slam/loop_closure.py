"""Loop closure: places that the robot has come back to.

The newest key scans are searched for in each earlier submap that the robot may be in,
as far as the uncertainty of the graph reaches. A match in a large window is used only
when another one, from other scans, agrees with it (pairwise consistency; Mangelson et
al. 2018).
"""

import math
from collections import OrderedDict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference, largest_stddev
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.motion import inverted
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.pose_graph import GraphEdge
from navette.navigation.slam.refinement import Refined, refine
from navette.navigation.slam.scan_graph import ScanChunk, ScanGraph
from navette.navigation.slam.scan_points import Points, thinned
from navette.navigation.slam.tracking import SIGMAS, LocalMap

Matrix = NDArray[np.float64]

_CACHED = 48
_LEVELS = 7
# Windows within which a match needs no other one: no two places of a building that look
# the same are nearer to each other.
_CERTAIN = SearchWindow(1.0, 0.35)
# Largest error between two matches that agree, and per distance between them.
_AGREE_M, _AGREE_RAD = 0.3, 0.08
_AGREE_PER_M = 0.03
# What the pose of a submap's scans relative to each other adds to an edge.
_FLOOR = np.diag([0.02**2, 0.02**2, 0.005**2])
# Information along a corridor, so that it can be inverted.
_WEAKEST = np.eye(3)
# Shifts of a match along its weakest direction, and the share of its score that another
# place must not reach.
_SLIDES_M = (-4.0, -3.0, -2.0, -1.0, 1.0, 2.0, 3.0, 4.0)
_SLIDE_WINDOW = SearchWindow(0.5, 0.05)
_ALIKE = 0.85
# Points of the newest key scans that are searched for.
_SAMPLE = 400


@dataclass(frozen=True)
class Closure:
    """A match between two chunks."""

    edge: GraphEdge
    window: SearchWindow
    overlap: float
    query: ScanChunk

    @property
    def is_certain(self) -> bool:
        return (
            self.window.distance_m <= _CERTAIN.distance_m
            and self.window.angle_rad <= _CERTAIN.angle_rad
        )


class LoopFinder:
    """Find closures for the newest key scans."""

    def __init__(self, params: SlamParams) -> None:
        self.params = params
        self._pending: list[Closure] = []
        self._maps: OrderedDict[ScanChunk, LocalMap] = OrderedDict()

    def find(self, query: ScanChunk, graph: ScanGraph) -> list[GraphEdge]:
        """Return the edges of the closures that are accepted now."""
        relative = graph.covariances_from(query.anchor)
        sample = thinned(chunk_points(query, graph), _SAMPLE)
        accepted: list[GraphEdge] = []
        for target in self._near(query, graph, relative):
            closure = self._match(query, sample, target, graph, relative)
            if closure is None:
                continue
            if closure.is_certain:
                accepted.append(closure.edge)
            else:
                accepted += self._confirm(closure, graph)
        return accepted

    def map_of(self, target: ScanChunk, graph: ScanGraph) -> LocalMap:
        """Return the surfaces of a chunk in its anchor's frame."""
        if target in self._maps:
            self._maps.move_to_end(target)
            return self._maps[target]
        local = LocalMap(chunk_points(target, graph), self.params, _LEVELS)
        self._maps[target] = local
        if len(self._maps) > _CACHED:
            self._maps.popitem(last=False)
        return local

    def _near(
        self, query: ScanChunk, graph: ScanGraph, relative: Matrix
    ) -> list[ScanChunk]:
        """Return the targets in reach, the most certain first, a few at most."""
        params, centers = self.params, graph.view_centers()
        here = centers[query.first : query.last].mean(axis=0)
        found = []
        for target in graph.chunks(params.submap_scans, params.submap_length_m):
            covariance = relative[target.anchor]
            if target.last > query.first or not np.isfinite(covariance[0, 0]):
                continue
            if not graph.has_points(target):
                continue
            there = centers[target.first : target.last].mean(axis=0)
            spread = min(_spread(covariance), params.loop_search_max_m)
            away = math.dist(here, there)
            if away < spread + params.loop_reach_m:
                found.append((spread + away, target))
        found.sort()
        return [target for _, target in found[: params.loop_targets]]

    def _match(
        self,
        query: ScanChunk,
        sample: Points,
        target: ScanChunk,
        graph: ScanGraph,
        relative: Matrix,
    ) -> Closure | None:
        params, covariance = self.params, relative[target.anchor]
        window = SearchWindow(
            min(_spread(covariance), params.loop_search_max_m),
            min(SIGMAS * math.sqrt(covariance[2, 2]), math.pi),
        )
        guess = graph.pose(target.anchor).inverse() @ graph.pose(query.anchor)
        local = self.map_of(target, graph)
        found = search(
            local.grid, sample, guess, window, min_score=params.loop_min_score
        )
        if found is None:
            return None
        refined = refine(
            local.surface, sample, found.pose, noise_m=params.match_noise_m
        )
        if refined.overlap < params.loop_min_overlap:
            return None
        edge = GraphEdge(
            target.anchor,
            query.anchor,
            refined.pose,
            softened(refined.information + _WEAKEST, _FLOOR),
            True,
        )
        closure = Closure(edge, window, refined.overlap, query)
        if not closure.is_certain and slides(local, sample, refined, found.score):
            return None
        return closure

    def _confirm(self, closure: Closure, graph: ScanGraph) -> list[GraphEdge]:
        """Return the pending closures that agree with this one, and this one."""
        agreeing = [
            each
            for each in self._pending
            if each.query.last <= closure.query.first + 2
            and _agree(each.edge, closure.edge, graph)
        ]
        if not agreeing:
            self._pending.append(closure)
            return []
        self._pending = [each for each in self._pending if each not in agreeing]
        return [closure.edge, *(each.edge for each in agreeing)]


def chunk_points(chunk: ScanChunk, graph: ScanGraph) -> Points:
    """Return the points of a chunk in the frame of its anchor."""
    return graph.points(range(chunk.first, chunk.last), graph.pose(chunk.anchor))


def softened(information: Matrix, floor: Matrix) -> Matrix:
    """Return the information of a measurement with an additional covariance."""
    result: Matrix = inverted(inverted(information) + floor)
    return result


def slides(local: LocalMap, sample: Points, refined: Refined, score: float) -> bool:
    """Whether the scans fit nearly as well elsewhere along the weakest direction.

    In a corridor whose doors look alike, the best place is not the right one.
    """
    _, directions = np.linalg.eigh(refined.information[:2, :2])
    x, y = directions[:, 0]
    for step in _SLIDES_M:
        pose = refined.pose
        moved = Pose2(pose.x + step * x, pose.y + step * y, pose.yaw)
        found = search(
            local.grid, sample, moved, _SLIDE_WINDOW, min_score=_ALIKE * score
        )
        if found is not None:
            return True
    return False


def _agree(one: GraphEdge, other: GraphEdge, graph: ScanGraph) -> bool:
    """Whether two closures agree, given the motion between their ends."""
    sources = graph.pose(one.source).inverse() @ graph.pose(other.source)
    targets = graph.pose(one.target).inverse() @ graph.pose(other.target)
    predicted = sources.inverse() @ one.source_T_target @ targets
    measured = other.source_T_target
    apart = math.hypot(sources.x, sources.y) + math.hypot(targets.x, targets.y)
    away = predicted.distance_to(measured)
    turn = abs(angle_difference(predicted.yaw, measured.yaw))
    return away < _AGREE_M + _AGREE_PER_M * apart and turn < _AGREE_RAD


def _spread(covariance: Matrix) -> float:
    """Return three standard deviations of the position, m."""
    return SIGMAS * largest_stddev(covariance)
