"""Pose in a known map without any idea where: every submap is searched whole."""

import math

import numpy as np

from navette.geometry import Pose2
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.refinement import refine
from navette.navigation.slam.scan_graph import ScanChunk, ScanGraph
from navette.navigation.slam.scan_points import Points, thinned
from navette.navigation.slam.tracking import LocalMap

# Least overlap of the place found, and by how much it must exceed that of others.
_LEAST, _MARGIN = 0.7, 0.08
# Places nearer to each other than this are one.
_APART = SearchWindow(1.0, 0.5)
# Share of the best score from which another place of a submap is compared.
_RIVAL = 0.8
_SAMPLE, _LEAST_POINTS = 400, 10
_LEVELS = 7
_REACH_M = 2.0


def locate(graph: ScanGraph, points: Points, params: SlamParams) -> Pose2 | None:
    """Return map_T_base of scans if exactly one place of the map looks like them.

    In rooms and corridors that look alike, or that fit after a half turn, more scans
    are needed.

    Args:
        graph: the known map.
        points: (N, 4) of the scans in the frame of the newest base.
        params: as of the SLAM.
    """
    if len(points) < _LEAST_POINTS:
        return None
    points = thinned(points, _SAMPLE)
    found: list[tuple[float, Pose2]] = []
    for chunk in _chunks(graph, params.submap_scans):
        found += _places(graph, chunk, points, params)
    if not found:
        return None
    best, pose = max(found, key=lambda each: each[0])
    rivals = [overlap for overlap, other in found if _is_apart(pose, other)]
    if best < _LEAST or max(rivals, default=0.0) > best - _MARGIN:
        return None
    return pose


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
