"""Joint refinement at the end of a run, and scans at a wrong maximum."""

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.slam import Slam, SlamParams
from navette.navigation.slam.global_refinement import overlapping_pairs, refine_all
from navette.navigation.slam.rematching import rematch_all
from slam_office import box, drive, loop, scan_at

PARAMS = SlamParams()


def refined_drive(seed: int) -> Slam:
    """Return the SLAM of a drive with a scan per metre, refined."""
    slam = Slam(PARAMS)
    for step in drive(seed=seed, poses=loop(1.0)):
        slam.add(step.stamp_ns, step.scan, step.odom_T_base)
    slam.refine()
    return slam


def displace(slam: Slam, node: int, offset: Pose2) -> None:
    """Move a key scan, with the measurements of the run that it belongs to."""
    graph = slam.graph
    poses = graph.poses.copy()
    poses[node] = graph.pose(node) @ offset
    graph.poses = poses
    graph.edges[:] = [
        each._replace(
            source_T_target=graph.pose(each.source).inverse() @ graph.pose(each.target)
        )
        for each in graph.edges
    ]


@pytest.mark.parametrize(
    "offset", [Pose2(0.5, 0.0, 0.0), Pose2(0.0, -0.5, 0.05), Pose2(-0.4, 0.4, -0.1)]
)
def test_a_scan_at_a_wrong_place_is_matched_again(offset: Pose2) -> None:
    slam = refined_drive(seed=1)
    graph, right = slam.graph, slam.graph.poses
    node = len(graph) // 2
    displace(slam, node, offset)
    assert rematch_all(graph, overlapping_pairs(graph), PARAMS) == 1
    np.testing.assert_allclose(graph.poses[node, :2], right[node, :2], atol=0.03)
    assert graph.poses[node, 2] == pytest.approx(right[node, 2], abs=0.01)
    unmoved = np.arange(len(graph)) != node
    np.testing.assert_array_equal(graph.poses[unmoved], right[unmoved])


def test_scans_at_their_place_stay() -> None:
    graph = refined_drive(seed=2).graph
    before = graph.poses.copy()
    assert rematch_all(graph, overlapping_pairs(graph), PARAMS) == 0
    np.testing.assert_array_equal(graph.poses, before)


def test_refinement_keeps_no_scan_at_a_wrong_place() -> None:
    slam = refined_drive(seed=3)
    right = slam.graph.poses
    node = len(slam.graph) // 2
    poses = right.copy()
    poses[node, :2] += 0.4
    slam.graph.poses = poses
    refine_all(slam.graph, PARAMS)
    away = np.linalg.norm((slam.graph.poses - right)[:, :2], axis=1)
    assert away.max() < 0.02


def test_submaps_without_echoes_are_left_out_of_the_search_for_loops() -> None:
    """The middle of a bare hall is out of range of the walls."""
    walls, slam = np.array(box(0.0, 0.0, 30.0, 30.0)), Slam(PARAMS)
    noise = np.random.default_rng(5)
    for k in range(140):
        along = 0.2 * k if k < 70 else 0.2 * (140 - k)
        pose = Pose2(5.0 + along, 15.0, 0.0)
        scan = scan_at(walls, pose, beams=180, noise=noise, range_m=6.0)
        slam.add((k + 1) * 100_000_000, scan, pose)
    slam.refine()
    assert any(not slam.graph.has_points(each) for each in slam.graph.chunks(10, 5.0))
    assert np.isfinite(slam.graph.poses).all()
