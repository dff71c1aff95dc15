"""The actions compute_path_* and the service is_path_valid."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from planner_graph import World
from planning_worlds import fill

from navette.geometry import Pose2
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.nav2_msgs.action import ComputePathThroughPoses, ComputePathToPose
from navette.msgs.nav2_msgs.srv import IsPathValid
from navette.msgs.nav_msgs.msg import Path
from navette.runtime.stage.path_messages import path_message, pose_message, poses_of
from navette.runtime.testing import GraphHarness

ToPose = ComputePathToPose.Result
ThroughPoses = ComputePathThroughPoses.Result


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


def stamped(x: float, y: float, yaw: float = 0.0, frame: str = "map") -> PoseStamped:
    msg = PoseStamped(pose=pose_message(Pose2(x, y, yaw)))
    msg.header.frame_id = frame
    return msg


def to_pose(graph: GraphHarness, goal: PoseStamped, **fields: Any) -> Any:
    request = ComputePathToPose.Goal(goal=goal, **fields)
    probe = graph.send_goal(ComputePathToPose, "compute_path_to_pose", request)
    assert graph.run_until(lambda: probe.done, 5.0)
    return probe


def test_the_path_leads_from_the_robot_to_the_goal(graph: GraphHarness) -> None:
    World(graph).ready()
    plans = graph.collect("/plan", Path)
    graph.run_for(0.1)
    probe = to_pose(graph, stamped(8.0, 4.0, math.pi / 2))
    assert probe.status == GoalStatus.STATUS_SUCCEEDED
    assert (probe.result.error_code, probe.result.error_msg) == (0, "")
    poses = poses_of(probe.result.path)
    np.testing.assert_allclose(poses[0], (1, 4, 0), atol=1e-9)
    np.testing.assert_allclose(poses[-1], (8, 4, math.pi / 2), atol=1e-9)
    assert probe.result.path.header.frame_id == "map"
    spent = probe.result.planning_time
    assert 0 < spent.sec + spent.nanosec / 1e9 < 60
    graph.run_for(0.1)
    assert plans.last == probe.result.path


def test_a_start_may_be_given(graph: GraphHarness) -> None:
    World(graph).ready()
    start = stamped(3.0, 2.0)
    used = to_pose(graph, stamped(8.0, 4.0), start=start, use_start=True)
    np.testing.assert_allclose(poses_of(used.result.path)[0, :2], (3, 2))
    ignored = to_pose(graph, stamped(8.0, 4.0), start=start, use_start=False)
    np.testing.assert_allclose(poses_of(ignored.result.path)[0, :2], (1, 4))


def test_a_frame_of_the_robot_is_converted(graph: GraphHarness) -> None:
    world = World(graph)
    world.pose = Pose2(5.0, 4.0, math.pi)
    world.ready()
    probe = to_pose(graph, stamped(3.0, 0.0, frame="base_link"))
    np.testing.assert_allclose(poses_of(probe.result.path)[-1, :2], (2, 4), atol=1e-9)


def test_the_goal_being_driven_is_not_disturbed(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.send(8.0, 4.0)
    graph.run_for(0.1)
    before = world.paths.count, world.message, world.values
    to_pose(graph, stamped(2.0, 6.0))
    to_pose(graph, stamped(2.0, 6.0), planner_id="breadth_first")
    to_pose(graph, stamped(200.0, 6.0))
    graph.run_for(0.3)
    assert (world.paths.count, world.message, world.values) == before


@pytest.mark.parametrize(
    "planner_id", ["", "GridBased", "a_star", "dijkstra", "breadth_first"]
)
def test_known_planners(graph: GraphHarness, planner_id: str) -> None:
    World(graph).ready()
    probe = to_pose(graph, stamped(8.0, 4.0), planner_id=planner_id)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED


def test_every_failure_has_a_code_and_a_reason(graph: GraphHarness) -> None:
    world = World(graph)
    early = to_pose(graph, stamped(8.0, 4.0))
    assert early.result.error_code == ToPose.TIMEOUT
    assert "map" in early.result.error_msg
    fill(world.occupancy, world.spec, (7.0, 9.0), (3.0, 5.0))
    world.ready()
    there = stamped(3.0, 4.0)
    nan = stamped(math.nan, 4.0)
    for goal, fields, code, reason in (
        (there, {"planner_id": "teb"}, ToPose.INVALID_PLANNER, "GridBased, a_star"),
        (stamped(3, 4, frame="moon"), {}, ToPose.TF_ERROR, "'moon'"),
        (
            there,
            {"start": stamped(0, 0, frame="moon"), "use_start": True},
            ToPose.TF_ERROR,
            "start in unknown frame",
        ),
        (
            there,
            {"start": stamped(-650, 4), "use_start": True},
            ToPose.START_OUTSIDE_MAP,
            "start_outside_map",
        ),
        (there, {"start": nan, "use_start": True}, ToPose.START_OUTSIDE_MAP, "start"),
        (stamped(500, 4), {}, ToPose.GOAL_OUTSIDE_MAP, "goal_outside_map"),
        (nan, {}, ToPose.GOAL_OUTSIDE_MAP, "goal_not_finite"),
        (stamped(8, 4), {}, ToPose.GOAL_OCCUPIED, "goal_blocked"),
    ):
        probe = to_pose(graph, goal, **fields)
        assert probe.status == GoalStatus.STATUS_ABORTED
        assert probe.result.error_code == code, probe.result
        assert reason in probe.result.error_msg
        assert probe.result.path.poses == []


def test_a_wall_between_leaves_no_valid_path(graph: GraphHarness) -> None:
    world = World(graph)
    fill(world.occupancy, world.spec, (5.0, 5.4), (0.0, 8.0))
    world.ready()
    probe = to_pose(graph, stamped(8.0, 4.0))
    assert probe.result.error_code == ToPose.NO_VALID_PATH


def test_an_enclosed_start_is_occupied(graph: GraphHarness) -> None:
    world = World(graph)
    for x0, x1, y0, y1 in (
        (0.5, 1.5, 3.5, 3.7),
        (0.5, 1.5, 4.3, 4.5),
        (0.5, 0.7, 3.5, 4.5),
        (1.3, 1.5, 3.5, 4.5),
    ):
        fill(world.occupancy, world.spec, (x0, x1), (y0, y1))
    world.ready()
    assert to_pose(graph, stamped(8.0, 4.0)).result.error_code == ToPose.START_OCCUPIED


def test_stale_odometry_is_a_tf_error(graph: GraphHarness) -> None:
    world = World(graph).ready()
    world.odometry = False
    graph.run_for(1.0)
    probe = to_pose(graph, stamped(8.0, 4.0))
    assert probe.result.error_code == ToPose.TF_ERROR
    given = to_pose(graph, stamped(8.0, 4.0), start=stamped(1, 4), use_start=True)
    assert given.status == GoalStatus.STATUS_SUCCEEDED


def through(graph: GraphHarness, goals: list[PoseStamped], **fields: Any) -> Any:
    request = ComputePathThroughPoses.Goal(goals=goals, **fields)
    name = "compute_path_through_poses"
    probe = graph.send_goal(ComputePathThroughPoses, name, request)
    assert graph.run_until(lambda: probe.done, 5.0)
    return probe


def test_a_path_leads_through_all_poses(graph: GraphHarness) -> None:
    World(graph).ready()
    stops = [(4.0, 6.0, 0.0), (8.0, 2.0, -1.0), (2.0, 2.0, math.pi)]
    probe = through(graph, [stamped(*stop) for stop in stops])
    assert probe.status == GoalStatus.STATUS_SUCCEEDED
    poses = poses_of(probe.result.path)
    at = [int(np.argmin(np.hypot(*(poses[:, :2] - stop[:2]).T))) for stop in stops]
    assert at == sorted(at)
    np.testing.assert_allclose(poses[at][:, :2], [s[:2] for s in stops], atol=1e-6)
    assert np.hypot(*np.diff(poses[:, :2], axis=0).T).max() < 0.11


def test_failures_of_a_path_through_poses(graph: GraphHarness) -> None:
    World(graph).ready()
    assert through(graph, []).result.error_code == ThroughPoses.NO_VIAPOINTS_GIVEN
    beyond = through(graph, [stamped(4, 4), stamped(500, 4), stamped(8, 4)])
    assert beyond.result.error_code == ThroughPoses.GOAL_OUTSIDE_MAP
    assert "goal 2 of 3" in beyond.result.error_msg
    unknown = through(graph, [stamped(4, 4)], planner_id="teb")
    assert unknown.result.error_code == ThroughPoses.INVALID_PLANNER


def test_a_path_is_checked_from_the_robot_on(graph: GraphHarness) -> None:
    world = World(graph)
    fill(world.occupancy, world.spec, (2.0, 2.5), (3.5, 4.5))
    fill(world.occupancy, world.spec, (7.0, 7.5), (3.5, 4.5))
    world.pose = Pose2(4.0, 4.0, 0.0)
    world.ready()

    def check(xs: list[float], frame: str = "map") -> IsPathValid.Response:
        poses = np.array([(x, 4.0, 0.0) for x in xs]).reshape(-1, 3)
        request = IsPathValid.Request(path=path_message(poses, frame, 0))
        response: IsPathValid.Response = graph.call(
            IsPathValid, "is_path_valid", request
        )
        return response

    free = check([2.2, 4.0, 5.0, 6.0])
    assert free.is_valid
    assert list(free.invalid_pose_indices) == []
    blocked = check([2.2, 4.0, 5.0, 7.2, 8.5, 50.0])
    assert not blocked.is_valid
    assert list(blocked.invalid_pose_indices) == [3, 5]
    assert not check([]).is_valid
    assert not check([4.0], frame="moon").is_valid
    assert not check([math.nan, 4.0]).is_valid


def test_a_goal_with_an_orientation_of_zeros_has_any_heading(
    graph: GraphHarness,
) -> None:
    world = World(graph)
    world.pose = Pose2(4.0, 4.0, 1.0)
    world.ready()
    goal = stamped(4.01, 4.01)
    goal.pose.orientation.w = 0.0
    reply = to_pose(graph, goal)
    headings = poses_of(reply.result.path)[:, 2]
    assert headings == pytest.approx([1.0] * len(headings))
