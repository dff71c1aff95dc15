"""Uncertainty of all poses of a graph relative to one of them.

Covariances are compounded along the most certain path from that pose (Dijkstra's
search; Olson 2008, "Robust and efficient robotic mapping", section 3.2): an upper bound
of the graph's own covariance, at a cost that allows one search per query.
"""

import heapq
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.slam.motion import inverted
from navette.navigation.slam.pose_graph import GraphEdge

Matrix = NDArray[np.float64]

# Metres that a radian of yaw is worth when paths are compared.
_YAW_LEVER_M = 3.0


class EdgeCovariances(NamedTuple):
    """Edges in both directions, sorted by their first node.

    Attributes:
        starts: (N + 1,) index of the first edge of each node.
        ends: (E,) the other node.
        covariances: (E, 3, 3) of the other node in the first one's frame.
    """

    starts: NDArray[np.int64]
    ends: NDArray[np.int64]
    covariances: Matrix


class EdgeList:
    """The edges of a growing graph, for queries of uncertainty."""

    def __init__(self) -> None:
        self._sources: list[int] = []
        self._targets: list[int] = []
        self._covariances: list[Matrix] = []

    def add(self, edge: GraphEdge) -> None:
        self._sources.append(edge.source)
        self._targets.append(edge.target)
        # A direction without information stays finite.
        self._covariances.append(inverted(edge.information + 1e-2 * np.eye(3)))

    def table(self, nodes: int) -> EdgeCovariances:
        sources = np.array(self._sources + self._targets, np.int64)
        targets = np.array(self._targets + self._sources, np.int64)
        both = np.concatenate([self._covariances, self._covariances]).reshape(-1, 3, 3)
        order = np.argsort(sources, kind="stable")
        starts = np.searchsorted(sources[order], np.arange(nodes + 1))
        return EdgeCovariances(
            starts.astype(np.int64),
            targets[order],
            np.ascontiguousarray(both[order]),
        )


def covariances_from(node: int, poses: Matrix, table: EdgeCovariances) -> Matrix:
    """Return (N, 3, 3) covariances of x, y, yaw, in the map's axes, relative to a node.

    Nodes without a path have NaN.
    """
    found: Matrix = _dijkstra(node, poses, table)
    return found


@kernel
def _dijkstra(node: int, poses: Matrix, table: EdgeCovariances) -> Matrix:
    count = poses.shape[0]
    result = np.full((count, 3, 3), np.nan)
    best = np.full(count, np.inf)
    done = np.zeros(count, np.bool_)
    result[node] = 0.0
    best[node] = 0.0
    heap = [(0.0, node)]
    while len(heap):
        _, at = heapq.heappop(heap)
        if done[at]:
            continue
        done[at] = True
        c, s = math.cos(poses[at, 2]), math.sin(poses[at, 2])
        p = result[at]
        for e in range(table.starts[at], table.starts[at + 1]):
            to = table.ends[e]
            if done[to]:
                continue
            a, b = poses[to, 1] - poses[at, 1], poses[to, 0] - poses[at, 0]
            q = table.covariances[e]
            # The edge's covariance in the map's axes, R Q Rᵀ.
            xx = c * c * q[0, 0] - 2 * c * s * q[0, 1] + s * s * q[1, 1]
            xy = c * s * (q[0, 0] - q[1, 1]) + (c * c - s * s) * q[0, 1]
            yy = s * s * q[0, 0] + 2 * c * s * q[0, 1] + c * c * q[1, 1]
            xt = c * q[0, 2] - s * q[1, 2]
            yt = s * q[0, 2] + c * q[1, 2]
            # J P Jᵀ with J = [1 0 −a; 0 1 b; 0 0 1].
            n_xt = p[0, 2] - a * p[2, 2]
            n_yt = p[1, 2] + b * p[2, 2]
            n_xx = p[0, 0] - a * p[0, 2] - a * n_xt
            n_yy = p[1, 1] + b * p[1, 2] + b * n_yt
            n_xy = p[0, 1] + b * p[0, 2] - a * n_yt
            cost = n_xx + xx + n_yy + yy
            cost += _YAW_LEVER_M * _YAW_LEVER_M * (p[2, 2] + q[2, 2])
            if cost < best[to]:
                best[to] = cost
                r = result[to]
                r[0, 0], r[1, 1], r[2, 2] = n_xx + xx, n_yy + yy, p[2, 2] + q[2, 2]
                r[0, 1] = r[1, 0] = n_xy + xy
                r[0, 2] = r[2, 0] = n_xt + xt
                r[1, 2] = r[2, 1] = n_yt + yt
                heapq.heappush(heap, (cost, to))
    return result
