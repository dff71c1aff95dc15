"""Poses connected by relative measurements, and their most likely values.

Gauss-Newton with Levenberg's damping on the sparse normal equations (Lu and Milios
1997; Grisetti et al. 2010, "A tutorial on graph-based SLAM"). Edges that may be wrong
carry a Cauchy weight.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference, wrap_angles
from navette.navigation.slam.block_cholesky import BlockCholesky

Matrix = NDArray[np.float64]

# Squared Mahalanobis distance from which a robust edge loses its weight (3 dof, 95 %).
_ROBUST = 7.8
_LARGEST_DAMPING = 1e6


class GraphEdge(NamedTuple):
    """A measurement of the pose of node ``target`` in the frame of node ``source``."""

    source: int
    target: int
    source_T_target: Pose2
    information: Matrix
    """(3, 3) inverse covariance of x, y (source's frame) and yaw"""
    is_robust: bool = False
    """whether the edge may be wrong"""


class Optimised(NamedTuple):
    """Poses (N, 3) after an optimisation, and their cost."""

    poses: Matrix
    cost: float


def optimise(
    poses: Matrix, edges: list[GraphEdge], *, steps: int = 20, tolerance: float = 1e-5
) -> Optimised:
    """Return the poses (N, 3) that fit the edges best; the first one is fixed.

    Every node must be connected to the first one.

    Args:
        poses: x, y, yaw of each node to start with.
        edges: the measurements.
        steps: most iterations.
        tolerance: relative decrease of the cost at which the iteration ends.
    """
    system = _System(len(poses), edges)
    poses = poses.copy()
    cost = system.cost(poses)
    damping = 0.0
    for _ in range(steps):
        step, new_cost, tried = system.step(poses, damping), math.inf, poses.copy()
        if step is not None:
            tried[1:] += step
            tried[:, 2] = wrap_angles(tried[:, 2])
            new_cost = system.cost(tried)
        if new_cost > cost * (1 + 1e-12) + 1e-12:
            damping = max(1e-4, 10.0 * damping)
            if damping > _LARGEST_DAMPING:
                break
            continue
        damping = 0.0 if damping < 1e-4 else damping / 10.0
        decrease = cost - new_cost
        poses, cost = tried, new_cost
        if decrease <= tolerance * cost:
            break
    return Optimised(poses, cost)


def mahalanobis(edge: GraphEdge, poses: Matrix) -> float:
    """Return the squared distance between an edge's measurement and the poses."""
    measured, source, target = (
        edge.source_T_target,
        Pose2(*poses[edge.source]),
        Pose2(*poses[edge.target]),
    )
    actual = source.inverse() @ target
    error = np.array(
        [
            actual.x - measured.x,
            actual.y - measured.y,
            angle_difference(actual.yaw, measured.yaw),
        ]
    )
    return float(error @ edge.information @ error)


class _System:
    """Normal equations of a set of edges."""

    def __init__(self, nodes: int, edges: list[GraphEdge]) -> None:
        self._i = np.array([each.source for each in edges])
        self._j = np.array([each.target for each in edges])
        self._z = np.array([each.source_T_target for each in edges])
        self._omega = np.array([each.information for each in edges])
        self._robust = np.array([each.is_robust for each in edges])
        # The first node is fixed: its rows and columns are omitted.
        self._free = (self._i > 0) & (self._j > 0)
        pairs = np.column_stack([self._i, self._j])[self._free] - 1
        self._solver = BlockCholesky(nodes - 1, pairs)

    def cost(self, poses: Matrix) -> float:
        error, _ = self._errors(poses)
        squared = np.einsum("ei,eij,ej->e", error, self._omega, error)
        robust = _ROBUST * np.log1p(squared / _ROBUST)
        return float(np.where(self._robust, robust, squared).sum())

    def step(self, poses: Matrix, damping: float) -> Matrix | None:
        """Return the changes (N - 1, 3) of a Gauss-Newton step; None: damp it more."""
        error, local = self._errors(poses)
        squared = np.einsum("ei,eij,ej->e", error, self._omega, error)
        weight = np.where(self._robust, 1.0 / (1.0 + squared / _ROBUST), 1.0)
        omega = self._omega * weight[:, None, None]
        c, s = np.cos(poses[self._i, 2]), np.sin(poses[self._i, 2])
        jj = np.zeros((len(c), 3, 3))
        jj[:, 0, 0], jj[:, 0, 1], jj[:, 1, 0], jj[:, 1, 1] = c, s, -s, c
        jj[:, 2, 2] = 1.0
        ji = -jj
        ji[:, 0, 2], ji[:, 1, 2] = local[:, 1], -local[:, 0]
        oi, oj = omega @ ji, omega @ jj
        diagonal, right = np.zeros((len(poses), 3, 3)), np.zeros((len(poses), 3))
        for at, jacobian, weighted in ((self._i, ji, oi), (self._j, jj, oj)):
            np.add.at(diagonal, at, np.einsum("eki,ekj->eij", jacobian, weighted))
            np.add.at(right, at, -np.einsum("eki,ek->ei", weighted, error))
        beside = np.einsum("eki,ekj->eij", ji[self._free], oj[self._free])
        diagonal[:, range(3), range(3)] *= 1.0 + damping
        return self._solver.solve(diagonal[1:], beside, right[1:])

    def _errors(self, poses: Matrix) -> tuple[Matrix, Matrix]:
        """Return the errors (E, 3) and the targets (E, 2) in their sources' frames."""
        source, target = poses[self._i], poses[self._j]
        c, s = np.cos(source[:, 2]), np.sin(source[:, 2])
        dx, dy = (target[:, :2] - source[:, :2]).T
        local = np.column_stack([c * dx + s * dy, c * dy - s * dx])
        error = np.empty((len(local), 3))
        error[:, :2] = local - self._z[:, :2]
        error[:, 2] = wrap_angles(target[:, 2] - source[:, 2] - self._z[:, 2])
        return error, local
