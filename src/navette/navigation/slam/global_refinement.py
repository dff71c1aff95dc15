"""Joint refinement of all key scans against the scans that overlap them.

Each pair of overlapping scans contributes the normal equations of its corresponding
points, linearised at the present poses, as an edge of the pose graph. The graph is
solved and the correspondences are found again (Lu and Milios 1997, with distances along
normals). The assumed noise of the points begins wide, so that surfaces far apart still
attract each other, and narrows (graduated non-convexity; Blake and Zisserman 1987,
Yang et al. 2020). Scans that remain at another maximum of their fit are matched again.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.point_map import PointMap, make_point_map
from navette.navigation.slam.pose_graph import GraphEdge, optimise
from navette.navigation.slam.refinement import solve, sum_equations
from navette.navigation.slam.rematching import rematch_all
from navette.navigation.slam.scan_graph import ScanGraph
from navette.navigation.slam.scan_points import Points

Matrix = NDArray[np.float64]
Pair = tuple[int, int]

# Noise of a point in the first rounds, as multiples of the parameter.
_WIDER = (6.0, 3.0, 2.0)
# Rounds of a width at most, and those after which the pairs are chosen again.
_ROUNDS, _PAIRING = 4, 2
# Times that scans are matched again, one by one.
_REMATCHES = 3
# Partners of a scan: the ones just before it and some of all others near it.
_PARTNERS = 8
_BEFORE = 3
_REACH_M = 6.0
_CONVERGED_M = 1e-3


def refine_all(graph: ScanGraph, params: SlamParams) -> None:
    """Improve all poses of a graph whose loops are closed."""
    if len(graph) < 2:
        return
    surfaces = [
        make_point_map(each.points, params.match_radius_m) if len(each.points) else None
        for each in graph.keys
    ]
    for width in _WIDER:
        wide = replace(params, match_noise_m=width * params.match_noise_m)
        _refine_jointly(graph, surfaces, wide)
    for _ in range(_REMATCHES):
        _refine_jointly(graph, surfaces, params)
        if not rematch_all(graph, overlapping_pairs(graph), params):
            break
    _refine_jointly(graph, surfaces, params)


def _refine_jointly(
    graph: ScanGraph, surfaces: list[PointMap | None], params: SlamParams
) -> None:
    """Match all pairs at the present poses and solve the graph, several times."""
    pairs: list[Pair] = []
    for turn in range(_ROUNDS):
        if turn % _PAIRING == 0:
            pairs = overlapping_pairs(graph)
        measured = [
            _pair_edge(graph, pair, surfaces[pair[0]], params) for pair in pairs
        ]
        edges = [edge for edge in measured if edge is not None]
        # The measurements of the run hold together what no pair connects.
        poses = optimise(graph.poses, graph.edges + edges, steps=3).poses
        moved = float(np.abs(poses - graph.poses)[:, :2].max())
        graph.poses = poses
        if moved < _CONVERGED_M:
            return


def overlapping_pairs(graph: ScanGraph) -> list[Pair]:
    """Return pairs (i, j), i < j, of key scans that look at the same place."""
    centers = graph.view_centers()
    pairs: list[Pair] = []
    for j, center in enumerate(centers):
        away = np.hypot(*(centers[:j] - center).T)
        earlier = np.flatnonzero(away <= _REACH_M)
        if len(earlier) > _PARTNERS:
            earlier = _spread_out(earlier, j, away)
        pairs.extend((i, j) for i in earlier.tolist())
    return sorted(pairs)


def _spread_out(
    earlier: NDArray[np.int64], j: int, away: NDArray[np.float64]
) -> NDArray[np.int64]:
    """Choose the partners of a scan: the last ones, and others from near to far."""
    recent, old = earlier[earlier >= j - _BEFORE], earlier[earlier < j - _BEFORE]
    old = old[np.argsort(away[old], kind="stable")]
    steps = np.linspace(0, len(old) - 1, _PARTNERS - len(recent)).astype(int)
    return np.concatenate([recent, old[np.unique(steps)]])


def _pair_edge(
    graph: ScanGraph, pair: Pair, surface: PointMap | None, params: SlamParams
) -> GraphEdge | None:
    """Return the measurement of scan j in the frame of scan i, if they overlap."""
    i, j = pair
    points = graph.keys[j].points
    if surface is None or not len(points):
        return None
    measured, information = np.empty(3), np.empty((3, 3))
    poses, noise_m = graph.poses, params.match_noise_m
    overlap = _match_pair(
        surface, points, poses[i], poses[j], noise_m, measured, information
    )
    if overlap < params.min_overlap:
        return None
    return GraphEdge(i, j, Pose2(*measured.tolist()), information, True)


@kernel
def _match_pair(
    surface: PointMap,
    points: Points,
    first: NDArray[np.float64],
    second: NDArray[np.float64],
    noise_m: float,
    measured: NDArray[np.float64],
    information: Matrix,
) -> float:
    """Write the pose of a scan in the frame of another, corrected by one step.

    Args:
        surface: of the first scan.
        points: of the second one.
        first, second: (3,) their poses.
        noise_m: standard deviation of a point's distance from the surface.

    Returns:
        The share of corresponding points; 0 if the step is too large.
    """
    c, s = math.cos(first[2]), math.sin(first[2])
    dx, dy = second[0] - first[0], second[1] - first[1]
    turn = second[2] - first[2]
    measured[0], measured[1] = c * dx + s * dy, c * dy - s * dx
    measured[2] = turn - math.tau * math.floor(turn / math.tau + 0.5)
    gradient, quality, step = np.empty(3), np.empty(2), np.empty(3)
    radius = surface.cell_m
    sum_equations(
        surface, points, measured, noise_m, radius, information, gradient, quality
    )
    # Where the pair has no information, the measurement is the present pose.
    damping = 1e-6 * (information[0, 0] + information[1, 1] + information[2, 2]) + 1e-9
    damped = information.copy()
    for k in range(3):
        damped[k, k] += damping
        gradient[k] = -gradient[k]
    if not solve(damped, gradient, step):
        return 0.0
    if max(abs(step[0]), abs(step[1]), abs(step[2])) > radius:
        return 0.0
    for k in range(3):
        measured[k] += step[k]
    overlap: float = quality[0]
    return overlap
