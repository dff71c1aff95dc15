"""Pose in a known map without any idea where: every submap is searched whole."""

import math

import numpy as np

from navette.geometry import Pose2
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.refinement import refine
from navette.navigation.slam.scan_graph import ScanChunk, ScanGraph
from navette.navigation.slam.scan_points import Points
from navette.navigation.slam.tracking import LocalMap

# Least overlap of the place found, and by how much it must exceed that of others.
_LEAST, _MARGIN = 0.7, 0.08
# Places nearer to each other than this are one.
_APART_M, _APART_RAD = 1.0, 0.5
_LEVELS = 7
_REACH_M = 2.0


def locate(graph: ScanGraph, points: Points, params: SlamParams) -> Pose2 | None:
    """Return map_T_base of a scan if exactly one place of the map looks like it.

    Args:
        graph: the known map.
        points: (N, 4) of the scan in the base frame.
        params: as of the SLAM.
    """
    found: list[tuple[float, Pose2]] = []
    for chunk in _chunks(graph, params.submap_scans):
        nodes = range(chunk.first, chunk.last)
        anchor = graph.pose(chunk.anchor)
        surfaces = graph.points(nodes, anchor)
        if not len(surfaces):
            continue
        local = LocalMap(surfaces, params, _LEVELS)
        poses = graph.poses[chunk.first : chunk.last]
        center = anchor.inverse().apply(poses[:, :2].mean(axis=0)[None])[0]
        spread = np.linalg.norm(poses[:, :2] - poses[:, :2].mean(axis=0), axis=1).max()
        window = SearchWindow(float(spread) + _REACH_M, math.pi)
        middle = Pose2(float(center[0]), float(center[1]), 0.0)
        result = search(
            local.grid, points, middle, window, min_score=params.loop_min_score
        )
        if result is None:
            continue
        refined = refine(
            local.surface, points, result.pose, noise_m=params.match_noise_m
        )
        found.append((refined.overlap, anchor @ refined.pose))
    if not found:
        return None
    best, pose = max(found, key=lambda each: each[0])
    rivals = [overlap for overlap, other in found if _is_apart(pose, other)]
    if best < _LEAST or max(rivals, default=0.0) > best - _MARGIN:
        return None
    return pose


def _chunks(graph: ScanGraph, size: int) -> list[ScanChunk]:
    """Return chunks that cover all key scans."""
    count = len(graph)
    return [ScanChunk(k, min(k + size, count)) for k in range(0, count, size)]


def _is_apart(one: Pose2, other: Pose2) -> bool:
    turn = abs(math.remainder(one.yaw - other.yaw, math.tau))
    return one.distance_to(other) > _APART_M or turn > _APART_RAD
