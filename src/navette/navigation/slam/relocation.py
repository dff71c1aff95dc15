"""Pose in a known map without any idea where: every submap is searched whole."""

import math
from typing import NamedTuple

import numpy as np

from navette.geometry import Pose2
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.motion import Matrix3
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.refinement import refine
from navette.navigation.slam.scan_graph import KeyScan, ScanChunk, ScanGraph
from navette.navigation.slam.scan_points import LEAST_POINTS, Points, thinned
from navette.navigation.slam.tracking import LocalMap, make_local_map
from navette.navigation.slam.visibility import SensorView

# Least overlap of the place found, and by how much its evidence must exceed that of
# others.
_LEAST, _MARGIN = 0.7, 0.08
# What a contradicting point takes from the evidence of matching ones.
_CONTRADICTING = 3.0
# Places nearer to each other than this are one.
_APART = SearchWindow(1.0, 0.5)
# Share of the best score from which another place of a submap is compared.
_RIVAL = 0.8
_SAMPLE = 400
_LEVELS = 7
_REACH_M = 2.0


class Relocation(NamedTuple):
    """What a search of the whole map found.

    Attributes:
        pose: map_T_base; None: not found.
        is_ambiguous: whether it was not found because several places look alike.
    """

    pose: Pose2 | None
    is_ambiguous: bool = False


def locate(
    graph: ScanGraph, points: Points, newest: KeyScan, params: SlamParams
) -> Relocation:
    """Return where scans were taken, if exactly one place of the map looks like them.

    A place that contradicts the newest scan looks unlike it, even where most surfaces
    fit: rooms have walls in common. In rooms and corridors that look alike, or that fit
    after a half turn, more scans are needed.

    Args:
        graph: the known map.
        points: (N, 4) of the scans in the frame of the newest base.
        newest: the newest of the scans.
        params: as of the SLAM.
    """
    if len(points) < LEAST_POINTS:
        return Relocation(None)
    points = thinned(points, _SAMPLE)
    places: list[tuple[float, Pose2]] = []
    for chunk in _chunks(graph, params.submap_scans):
        places += _places(graph, chunk, points, params)
    judged = _judged(graph, places, newest, params)
    if not judged:
        return Relocation(None)
    best, pose = max(judged, key=lambda each: each[0])
    rivals = [evidence for evidence, other in judged if _is_apart(pose, other)]
    if max(rivals, default=-math.inf) > best - _MARGIN:
        return Relocation(None, is_ambiguous=True)
    return Relocation(pose)


def anywhere_covariance(graph: ScanGraph, pose: Pose2) -> Matrix3:
    """Return the covariance (3, 3) about a pose of a robot that may be anywhere.

    The distribution is uniform over the rectangle around the key scans of the map, and
    over all headings.
    """
    places = graph.poses[:, :2]
    low, high = places.min(axis=0) - _REACH_M, places.max(axis=0) + _REACH_M
    away = (low + high) / 2.0 - (pose.x, pose.y)
    covariance = np.diag([*((high - low) ** 2 / 12.0), math.pi**2 / 3.0])
    covariance[:2, :2] += np.outer(away, away)
    return covariance


def evidence_of(overlap: float, contradicted: float) -> float:
    """Return the evidence for a place: shares of points that match and contradict."""
    return overlap - _CONTRADICTING * contradicted


def _judged(
    graph: ScanGraph,
    places: list[tuple[float, Pose2]],
    newest: KeyScan,
    params: SlamParams,
) -> list[tuple[float, Pose2]]:
    """Return evidence and map_T_base of the places that the best may be mistaken for.

    Args:
        graph: the known map.
        places: overlap and map_T_base.
        newest: the scan that may contradict them.
        params: as of the SLAM.
    """
    view = SensorView(newest.scan, newest.base_T_sensor)
    judged: list[tuple[float, Pose2]] = []
    best = -math.inf
    for overlap, pose in sorted(places, key=lambda each: -each[0]):
        # Evidence is at most the overlap.
        if overlap < max(_LEAST, best - _MARGIN):
            break
        nodes = graph.nearest(pose, 2 * params.local_scans)
        local = make_local_map(graph, nodes, pose, params)
        evidence = evidence_of(overlap, local.contradiction(view, newest.points, pose))
        judged.append((evidence, pose))
        best = max(best, evidence)
    return judged


def _places(
    graph: ScanGraph, chunk: ScanChunk, points: Points, params: SlamParams
) -> list[tuple[float, Pose2]]:
    """Return overlap and map_T_base of the best two places around a chunk."""
    anchor = graph.pose(chunk.anchor)
    surfaces = graph.points(range(chunk.first, chunk.last), anchor)
    if not len(surfaces):
        return []
    local = LocalMap(surfaces, params, _LEVELS)
    poses = graph.poses[chunk.first : chunk.last, :2]
    center = anchor.inverse().apply(poses.mean(axis=0)[None])[0]
    spread = np.linalg.norm(poses - poses.mean(axis=0), axis=1).max()
    window = SearchWindow(float(spread) + _REACH_M, math.pi)
    middle = Pose2(float(center[0]), float(center[1]), 0.0)
    found: list[tuple[float, Pose2]] = []
    starts: list[Pose2] = []
    least = params.loop_min_score
    for _ in range(2):
        result = search(
            local.grid, points, middle, window,
            min_score=least, excluded=starts, apart=_APART,
        )  # fmt: skip
        if result is None:
            break
        starts.append(result.pose)
        least = max(least, _RIVAL * result.score)
        refined = refine(
            local.surface, points, result.pose, noise_m=params.match_noise_m
        )
        found.append((refined.overlap, anchor @ refined.pose))
    return found


def _chunks(graph: ScanGraph, size: int) -> list[ScanChunk]:
    """Return chunks that cover all key scans."""
    count = len(graph)
    return [ScanChunk(k, min(k + size, count)) for k in range(0, count, size)]


def _is_apart(one: Pose2, other: Pose2) -> bool:
    turn = abs(math.remainder(one.yaw - other.yaw, math.tau))
    return one.distance_to(other) > _APART.distance_m or turn > _APART.angle_rad
