"""Smoothing of paths, and the action smooth_path."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from planner_graph import World
from planning_worlds import fill

from navette.geometry import Pose2, angle_difference
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.nav2_msgs.action import SmoothPath
from navette.navigation.planning.path_shape import directions, headed, turn_in_place
from navette.runtime.stage.path_messages import path_message, poses_of
from navette.runtime.testing import GraphHarness

Result = SmoothPath.Result
ZIGZAG = headed(np.array([(1, 2), (3, 2), (3, 4), (5, 4), (5, 6), (8, 6.0)]))


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


def smoothed(
    graph: GraphHarness, poses: np.ndarray, frame: str = "map", **fields: Any
) -> Any:
    goal = SmoothPath.Goal(path=path_message(poses, frame, 0), **fields)
    probe = graph.send_goal(SmoothPath, "smooth_path", goal)
    assert graph.run_until(lambda: probe.done, 5.0)
    return probe


def sharpest(poses: np.ndarray) -> float:
    """Return the largest change of heading between successive poses, rad."""
    change = np.diff(poses[:, 2])
    return float(np.abs(np.remainder(change + np.pi, 2 * np.pi) - np.pi).max())


def test_corners_are_rounded_and_the_ends_stay(graph: GraphHarness) -> None:
    World(graph).ready()
    probe = smoothed(graph, ZIGZAG)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED
    assert probe.result.was_completed
    poses = poses_of(probe.result.path)
    np.testing.assert_allclose(poses[[0, -1], :2], ZIGZAG[[0, -1], :2])
    assert sharpest(poses) < 0.5 < sharpest(ZIGZAG)
    assert np.hypot(*np.diff(poses[:, :2], axis=0).T).max() <= 0.1 + 1e-9


@pytest.mark.parametrize("yaw", [math.pi, 0.0])
def test_a_path_with_only_a_goal_heading_keeps_that(
    graph: GraphHarness, yaw: float
) -> None:
    World(graph).ready()
    poses = ZIGZAG.copy()
    poses[:, 2] = 0.0
    poses[:, :2] = poses[:, 1::-1]  # the last stretch leads up
    poses[-1, 2] = yaw
    found = poses_of(smoothed(graph, poses).result.path)
    assert abs(angle_difference(found[-1, 2], yaw)) < 1e-6
    assert abs(angle_difference(found[0, 2], math.pi / 2)) < 0.1


def test_reverse_pieces_turns_and_the_goal_heading_are_kept(
    graph: GraphHarness,
) -> None:
    World(graph).ready()
    ahead = headed(np.array([(1, 4), (2, 4), (3, 4.0)]))
    back = np.array([(3, 4, 0), (2.5, 3.8, 0.3), (2, 3.5, 0.6)])
    turn = turn_in_place(2, 3.5, 0.6, 2.0)
    path = np.concatenate([ahead, back[1:], turn[1:]])
    poses = poses_of(smoothed(graph, path).result.path)
    travel = directions(poses)
    kinds = [int(k) for i, k in enumerate(travel) if i == 0 or k != travel[i - 1]]
    assert kinds[0] == 1
    assert -1 in kinds
    assert abs(angle_difference(poses[-1, 2], 2.0)) < 1e-9


def test_a_path_without_headings_gets_them(graph: GraphHarness) -> None:
    World(graph).ready()
    points = np.array([(8, 2), (5, 2), (5, 6), (1, 6.0)])
    unset = np.column_stack([points, np.zeros(len(points))])
    poses = poses_of(smoothed(graph, unset).result.path)
    assert (directions(poses) >= 0).all()
    assert abs(angle_difference(poses[10, 2], math.pi)) < 0.3


@pytest.mark.parametrize(
    ("poses", "frame", "fields", "code"),
    [
        (ZIGZAG, "map", {"smoother_id": "x"}, Result.INVALID_SMOOTHER),
        (np.empty((0, 3)), "map", {}, Result.INVALID_PATH),
        (ZIGZAG, "moon", {}, Result.INVALID_PATH),
        (np.array([(math.nan, 0, 0)]), "map", {}, Result.INVALID_PATH),
    ],
)
def test_invalid_goals(
    graph: GraphHarness, poses: np.ndarray, frame: str, fields: Any, code: int
) -> None:
    World(graph).ready()
    probe = smoothed(graph, poses, frame, **fields)
    assert probe.status == GoalStatus.STATUS_ABORTED
    assert probe.result.error_code == code
    assert probe.result.error_msg


def test_collisions_are_found_on_request(graph: GraphHarness) -> None:
    world = World(graph)
    assert smoothed(graph, ZIGZAG).result.error_code == Result.FAILED_TO_SMOOTH_PATH
    fill(world.occupancy, world.spec, (2.8, 3.2), (2.5, 3.5))
    world.pose = Pose2(1, 2, 0)
    world.ready()
    found = smoothed(graph, ZIGZAG, check_for_collisions=True)
    assert found.result.error_code == Result.SMOOTHED_PATH_IN_COLLISION
    unchecked = smoothed(graph, ZIGZAG, smoother_id="simple_smoother")
    assert unchecked.status == GoalStatus.STATUS_SUCCEEDED
