"""Scans at a wrong maximum of their fit, found at the end of a run.

The joint refinement follows gradients. A scan that was placed half a metre off, beside
a wall that looks like its own, stays there and pulls at its neighbours. Each scan that
fits badly is therefore searched for in the map of the scans that overlap it.
"""

from collections.abc import Iterable

from navette.geometry import Pose2, angle_difference
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.refinement import Refined, refine
from navette.navigation.slam.scan_graph import ScanGraph
from navette.navigation.slam.scan_points import LEAST_POINTS, Points
from navette.navigation.slam.tracking import LocalMap

# Fit from which a scan is left where it is, and what another place must gain.
_GOOD, _GAIN = 0.7, 0.1
# How far away another maximum may be, and how many of them are refined.
_WINDOW = SearchWindow(0.6, 0.15)
_MAXIMA = 3
# Share of the best score that another maximum reaches.
_RIVAL = 0.5
_LEAST_PARTNERS = 2
# Poses nearer to each other than this are left to the joint refinement.
_NEAR_M, _NEAR_RAD = 0.15, 0.05


def rematch_all(
    graph: ScanGraph, pairs: Iterable[tuple[int, int]], params: SlamParams
) -> int:
    """Move scans to where they fit clearly better; return how many moved.

    Args:
        graph: whose poses change, except the first.
        pairs: nodes whose scans overlap.
        params: radius and noise of the match.
    """
    partners: list[set[int]] = [set() for _ in graph.keys]
    for i, j in pairs:
        partners[i].add(j)
        partners[j].add(i)
    count = 0
    for node in range(1, len(graph)):
        pose = _better_pose(graph, node, sorted(partners[node]), params)
        if pose is not None:
            poses = graph.poses.copy()
            poses[node] = pose
            graph.poses = poses
            count += 1
    return count


def _better_pose(
    graph: ScanGraph, node: int, partners: list[int], params: SlamParams
) -> Pose2 | None:
    """Return the pose at which a scan fits clearly better to its partners' map."""
    points = graph.keys[node].points
    surfaces = graph.points(partners)
    if (
        min(len(points), len(surfaces)) < LEAST_POINTS
        or len(partners) < _LEAST_PARTNERS
    ):
        return None
    local, present = LocalMap(surfaces, params), graph.pose(node)
    here = _refined(local, points, present, params)
    if _is_near(here.pose, present):
        fit = here.fit(params.match_noise_m)
    else:
        still = refine(
            local.surface, points, present, noise_m=params.match_noise_m, steps=0
        )
        fit = still.fit(params.match_noise_m)
    if fit > _GOOD:
        return None
    best = max(
        (here, *_maxima(local, points, here.pose, params)),
        key=lambda each: each.fit(params.match_noise_m),
    )
    is_better = best.fit(params.match_noise_m) > fit + _GAIN
    if not is_better or best.overlap < params.loop_min_overlap:
        return None
    return None if _is_near(best.pose, present) else best.pose


def _maxima(
    local: LocalMap, points: Points, known: Pose2, params: SlamParams
) -> list[Refined]:
    """Return matches at other maxima of the score around a known one."""
    matches: list[Refined] = []
    least, starts = 0.0, [known]
    for _ in range(_MAXIMA):
        found = search(
            local.grid, points, known, _WINDOW, min_score=least, excluded=starts
        )
        if found is None:
            break
        least = max(least, _RIVAL * found.score)
        matches.append(_refined(local, points, found.pose, params))
        starts += (found.pose, matches[-1].pose)
    return matches


def _is_near(one: Pose2, other: Pose2) -> bool:
    turn = abs(angle_difference(one.yaw, other.yaw))
    return one.distance_to(other) < _NEAR_M and turn < _NEAR_RAD


def _refined(
    local: LocalMap, points: Points, start: Pose2, params: SlamParams
) -> Refined:
    return refine(local.surface, points, start, noise_m=params.match_noise_m)
