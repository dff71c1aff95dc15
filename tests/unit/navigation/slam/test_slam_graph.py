"""Optimisation of pose graphs, and the uncertainty of their poses."""

from itertools import pairwise

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.slam.motion import ScanMotion, inverted, moved_covariance
from navette.navigation.slam.pose_graph import GraphEdge, mahalanobis, optimise
from navette.navigation.slam.relative_covariance import EdgeList, covariances_from

INFORMATION = inverted(np.diag([0.1**2, 0.05**2, 0.02**2]))


def square(side: int) -> list[Pose2]:
    poses = [Pose2(0.0, 0.0, 0.0)]
    for _ in range(4):
        poses += [poses[-1] @ Pose2(1.0, 0.0, 0.0)]
        for _ in range(side - 1):
            poses.append(poses[-1] @ Pose2(1.0, 0.0, 0.0))
        poses[-1] = poses[-1] @ Pose2(0.0, 0.0, np.pi / 2)
    return poses


def chain(poses: list[Pose2], seed: int) -> tuple[np.ndarray, list[GraphEdge]]:
    """Return poses by dead reckoning with noise, and their edges."""
    noise = np.random.default_rng(seed)
    reckoned, edges = [poses[0]], []
    for k, (one, other) in enumerate(pairwise(poses)):
        x, y, yaw = one.inverse() @ other
        dx, dy, turn = noise.normal(size=3) * (0.1, 0.05, 0.02)
        measured = Pose2(x + dx, y + dy, yaw + turn)
        edges.append(GraphEdge(k, k + 1, measured, INFORMATION))
        reckoned.append(reckoned[-1] @ measured)
    return np.array(reckoned), edges


def test_a_closure_pulls_the_whole_loop() -> None:
    truth = square(10)
    poses, edges = chain(truth, 1)
    closing = truth[0].inverse() @ truth[-1]
    edges.append(GraphEdge(0, len(truth) - 1, closing, 100 * INFORMATION, True))
    result = optimise(poses, edges)
    before = np.linalg.norm(poses[:, :2] - np.array(truth)[:, :2], axis=1)
    after = np.linalg.norm(result.poses[:, :2] - np.array(truth)[:, :2], axis=1)
    assert after[-1] < 0.1 < before[-1]
    assert np.sqrt((after**2).mean()) < 0.6 * np.sqrt((before**2).mean())
    np.testing.assert_array_equal(result.poses[0], poses[0])


def test_the_optimum_has_no_smaller_cost_nearby() -> None:
    truth = square(3)
    poses, edges = chain(truth, 2)
    edges.append(GraphEdge(0, 12, Pose2(0.1, 0.1, 0.0), INFORMATION))
    best = optimise(poses, edges, steps=50, tolerance=1e-12)

    def cost(at: np.ndarray) -> float:
        return sum(mahalanobis(each, at) for each in edges)

    assert best.cost == pytest.approx(cost(best.poses), rel=1e-9)
    noise = np.random.default_rng(3)
    for _ in range(50):
        near = best.poses.copy()
        near[1:] += 1e-3 * noise.normal(size=near[1:].shape)
        assert cost(near) > best.cost


def test_a_wrong_closure_loses_its_weight() -> None:
    truth = square(10)
    poses, edges = chain(truth, 4)
    end = len(truth) - 1
    edges += [
        GraphEdge(0, end, truth[0].inverse() @ truth[-1], 100 * INFORMATION, True),
        GraphEdge(1, end - 1, truth[1].inverse() @ truth[-2], 100 * INFORMATION, True),
    ]
    clean = optimise(poses, edges).poses
    wrong = GraphEdge(5, 25, Pose2(0.5, 0.0, 0.0), 100 * INFORMATION, True)
    spoilt = optimise(poses, [*edges, wrong]).poses
    assert np.abs(clean - spoilt)[:, :2].max() < 0.15


def test_covariances_grow_along_a_chain_as_compounding_gives() -> None:
    poses = [Pose2(0.7 * k, 0.1 * k * k, 0.2 * k) for k in range(6)]
    edges, table = [], EdgeList()
    for k in range(5):
        edge = GraphEdge(k, k + 1, poses[k].inverse() @ poses[k + 1], INFORMATION)
        edges.append(edge)
        table.add(edge)
    expected = np.zeros((3, 3))
    for k, edge in enumerate(edges):
        step = ScanMotion(edge.source_T_target, inverted(INFORMATION))
        expected = moved_covariance(expected, poses[k], step)
    at = np.array(poses)
    found = covariances_from(0, at, table.table(6))
    np.testing.assert_allclose(found[5], expected, rtol=1e-3)


def test_the_most_certain_path_counts() -> None:
    table = EdgeList()
    poses = np.array([[0.0, 0, 0], [5.0, 0, 0], [0.1, 0, 0]])
    weak, strong = inverted(np.eye(3)), inverted(1e-4 * np.eye(3))
    table.add(GraphEdge(0, 1, Pose2(5.0, 0.0, 0.0), weak))
    table.add(GraphEdge(1, 2, Pose2(-4.9, 0.0, 0.0), weak))
    table.add(GraphEdge(0, 2, Pose2(0.1, 0.0, 0.0), strong))
    found = covariances_from(2, poses, table.table(3))
    assert found[0, 0, 0] == pytest.approx(1e-4, rel=0.01)
    np.testing.assert_array_equal(found[2], 0.0)


def test_a_node_without_a_path_has_no_covariance() -> None:
    table = EdgeList()
    table.add(GraphEdge(0, 1, Pose2(1.0, 0.0, 0.0), INFORMATION))
    found = covariances_from(0, np.zeros((3, 3)), table.table(3))
    assert np.isnan(found[2]).all()


def test_poses_that_no_edge_measures_stay() -> None:
    poses, edges = chain(square(3), 4)
    nothing = edges[-1]._replace(information=np.zeros((3, 3)))
    result = optimise(poses, [*edges[:-1], nothing])
    np.testing.assert_array_equal(result.poses[-1], poses[-1])
