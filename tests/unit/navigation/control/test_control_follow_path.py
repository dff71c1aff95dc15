"""The action follow_path, /speed_limit and the state of the collision check."""

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from control_graph import World
from control_plant import tangent_path

from navette.geometry import Pose2
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.geometry_msgs.msg import PolygonStamped
from navette.msgs.nav2_msgs.action import FollowPath
from navette.msgs.nav2_msgs.msg import CollisionMonitorState, SpeedLimit
from navette.msgs.nav_msgs.msg import Path
from navette.runtime import Parameter
from navette.runtime.stage.path_messages import path_message
from navette.runtime.testing import GraphHarness

STRAIGHT = tangent_path(np.array([[0, 0], [3, 0.0]]))
Result = FollowPath.Result


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


@pytest.fixture
def world(graph: GraphHarness) -> World:
    made = World(graph)
    graph.run_for(1.0)
    return made


def follow(
    world: World, poses: Any = STRAIGHT, frame: str = "map", **fields: str
) -> Any:
    goal = FollowPath.Goal(path=path_message(np.asarray(poses), frame, 0), **fields)
    return world.graph.send_goal(FollowPath, "follow_path", goal)


def finished(world: World, probe: Any, timeout_s: float = 30.0) -> Any:
    assert world.graph.run_until(lambda: probe.done, timeout_s)
    return probe.result


def test_the_robot_follows_the_path_and_rests_before_the_result(world: World) -> None:
    world.planner = False  # the goal alone is enough
    world.graph.run_for(3.0)
    probe = follow(world)
    result = finished(world, probe)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED
    assert (result.error_code, result.error_msg) == (Result.NONE, "")
    assert abs(world.plant.speed) <= 0.03
    assert math.dist(world.plant.pose[:2], (3.0, 0.0)) < 0.1
    left = [feedback.distance_to_goal for feedback in probe.feedback]
    assert left[0] == pytest.approx(3.0, abs=0.05)
    assert left == sorted(left, reverse=True)
    assert max(feedback.speed for feedback in probe.feedback) == pytest.approx(0.5)


def test_it_drives_as_a_path_on_the_topic_does() -> None:
    def commands(send: Any) -> list[tuple[float, float]]:
        with GraphHarness() as graph:
            world = World(graph)
            graph.run_for(1.0)
            send(world)
            graph.run_for(10.0)
            moving = [(m.linear.x, m.angular.z) for m in world.commands.messages]
            return [each for each in moving if any(each)]

    bend = tangent_path(np.array([[0, 0], [1, 0], [1.7, 0.3], [2, 1], [2, 2.0]]))
    by_topic = commands(lambda world: world.send_path(bend))
    by_goal = commands(lambda world: follow(world, bend))
    assert len(by_goal) > 50
    assert by_goal == by_topic


def test_a_cancelled_goal_is_answered_at_rest(world: World) -> None:
    probe = follow(world)
    world.graph.run_until(lambda: world.plant.speed > 0.4, 10.0)
    probe.cancel()
    result = finished(world, probe, 3.0)
    assert probe.status == GoalStatus.STATUS_CANCELED
    assert result.error_code == Result.NONE
    assert abs(world.plant.speed) <= 0.03
    place = world.plant.pose
    world.graph.run_for(3.0)
    assert math.dist(world.plant.pose[:2], place[:2]) < 0.02


def test_a_new_goal_preempts_the_old_one_without_a_stop(world: World) -> None:
    first = follow(world)
    world.graph.run_until(lambda: world.plant.pose.x > 1.0, 10.0)
    second = follow(world, tangent_path(np.array([[0, 0], [5, 0.0]])))
    world.graph.run_for(0.2)
    assert first.status == GoalStatus.STATUS_ABORTED
    assert first.result.error_msg == "preempted by a new goal"
    speeds = []
    while not second.done:
        world.graph.run_for(0.05)
        speeds.append((world.plant.pose.x, world.plant.speed))
    assert second.status == GoalStatus.STATUS_SUCCEEDED
    assert world.plant.pose.x > 4.9
    assert min(speed for x, speed in speeds if x < 4.0) > 0.4


def test_the_newest_command_wins_between_goal_and_topic(world: World) -> None:
    probe = follow(world)
    world.graph.run_for(1.0)
    world.send_path(tangent_path(np.array([[0, 0], [0, 2.0]])))
    result = finished(world, probe, 1.0)
    assert probe.status == GoalStatus.STATUS_ABORTED
    assert "/path" in result.error_msg
    assert world.graph.run_until(lambda: world.state == "reached", 30.0)
    assert math.dist(world.plant.pose[:2], (0.0, 2.0)) < 0.15
    again = follow(world, tangent_path(np.array([[0, 2], [2, 2.0]])))
    finished(world, again)
    assert again.status == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.parametrize(
    ("fields", "poses", "frame", "code", "reason"),
    [
        ({"controller_id": "teb"}, STRAIGHT, "map", "INVALID_CONTROLLER", "FollowPath"),
        ({"goal_checker_id": "x"}, STRAIGHT, "map", "UNKNOWN", "general_goal_checker"),
        ({"progress_checker_id": "x"}, STRAIGHT, "map", "UNKNOWN", "progress_checker"),
        ({}, np.empty((0, 3)), "map", "INVALID_PATH", "empty"),
        ({}, [(0, 0, 0), (math.nan, 0, 0)], "map", "INVALID_PATH", "finite"),
        ({}, STRAIGHT, "moon", "TF_ERROR", "'moon'"),
    ],
)
def test_an_invalid_goal_is_aborted_with_its_code(
    world: World, fields: dict[str, str], poses: Any, frame: str, code: str, reason: str
) -> None:
    probe = follow(world, poses, frame, **fields)
    result = finished(world, probe, 3.0)
    assert probe.status == GoalStatus.STATUS_ABORTED
    assert result.error_code == getattr(Result, code)
    assert reason in result.error_msg
    assert world.commands.count == 0


@pytest.mark.parametrize(
    "controller", ["", "FollowPath", "pure_pursuit", "cross_track_pid"]
)
def test_known_controllers(world: World, controller: str) -> None:
    fields = {
        "controller_id": controller,
        "goal_checker_id": "general_goal_checker",
        "progress_checker_id": "progress_checker",
    }
    probe = follow(world, **fields)
    finished(world, probe)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED


def test_a_path_in_a_frame_of_the_robot_is_converted(world: World) -> None:
    world.plant.pose = Pose2(1.0, 1.0, math.pi / 2)
    world.graph.run_for(0.5)
    finished(world, follow(world, STRAIGHT, "base_link"))
    assert math.dist(world.plant.pose[:2], (1.0, 4.0)) < 0.15


def test_a_wall_exhausts_the_patience(world: World) -> None:
    world.wall_x = 1.5
    probe = follow(world)
    result = finished(world, probe)
    assert result.error_code == Result.PATIENCE_EXCEEDED
    assert "blocked for 2.0 s" in result.error_msg
    assert world.plant.pose.x + 0.25 < 1.5
    assert abs(world.plant.speed) <= 0.03


def test_lost_inputs_have_their_codes(world: World) -> None:
    probe = follow(world)
    world.graph.run_for(1.0)
    world.lidar = False
    assert finished(world, probe, 6.0).error_code == Result.CONTROLLER_TIMED_OUT
    world.lidar = True
    world.graph.run_for(0.5)
    probe = follow(world)
    world.graph.run_for(1.0)
    world.odometry = False
    assert finished(world, probe, 6.0).error_code == Result.TF_ERROR


def test_a_robot_that_does_not_move_stalls(world: World) -> None:
    probe = follow(world, tangent_path(np.array([[0, 0], [3, 0.0]])))
    world.plant.lag_s = 1e9  # the wheels do not turn
    result = finished(world, probe, 15.0)
    assert result.error_code == Result.FAILED_TO_MAKE_PROGRESS
    assert "stalled for 2.0 s" in result.error_msg


def test_a_robot_that_creeps_makes_no_progress(world: World) -> None:
    """It moves as commanded, so it does not stall, but not far enough."""
    world.graph.publish("/speed_limit", SpeedLimit(speed_limit=0.03))
    probe = follow(world, tangent_path(np.array([[0, 0], [3, 0.0]])))
    result = finished(world, probe, 15.0)
    assert result.error_code == Result.FAILED_TO_MAKE_PROGRESS
    assert "in 10 s (following)" in result.error_msg


def test_speed_limits_apply_and_are_removed(world: World) -> None:
    def top_speed(limit: SpeedLimit) -> float:
        world.graph.publish("/speed_limit", limit)
        probe = follow(world, STRAIGHT + np.array((world.plant.pose.x, 0, 0)))
        finished(world, probe, 60.0)
        return float(max(feedback.speed for feedback in probe.feedback))

    assert top_speed(SpeedLimit(speed_limit=0.2)) == pytest.approx(0.2)
    half = SpeedLimit(percentage=True, speed_limit=50.0)
    assert top_speed(half) == pytest.approx(0.25)
    for refused in (math.nan, -1.0):
        assert top_speed(SpeedLimit(speed_limit=refused)) == pytest.approx(0.25)
    world.node.set_parameters([Parameter("lookahead_m", value=0.9)])
    assert top_speed(half) == pytest.approx(0.25)
    assert top_speed(SpeedLimit()) == pytest.approx(0.5)


def test_a_limit_brakes_within_the_deceleration(world: World) -> None:
    probe = follow(world)
    world.graph.run_until(lambda: world.plant.speed > 0.45, 10.0)
    world.graph.publish("/speed_limit", SpeedLimit(speed_limit=0.1))
    world.graph.run_for(1.0)
    speeds = [feedback.speed for feedback in probe.feedback]
    assert min(speeds[-5:]) == pytest.approx(0.1)
    assert max(a - b for a, b in itertools.pairwise(speeds)) < 0.051


def test_the_collision_check_publishes_its_state(world: World) -> None:
    states = world.graph.collect("/collision_monitor_state", CollisionMonitorState)
    world.wall_x = 1.5
    finished(world, follow(world))
    world.graph.run_for(0.1)
    actions = [state.action_type for state in states.messages]
    assert CollisionMonitorState.STOP in actions
    assert actions[-1] == CollisionMonitorState.DO_NOTHING
    for state in states.messages:
        idle = state.action_type == CollisionMonitorState.DO_NOTHING
        assert state.polygon_name == ("" if idle else "footprint")
    assert all(a != b for a, b in itertools.pairwise(actions))


def test_an_empty_path_on_the_topic_stops_a_goal(world: World) -> None:
    probe = follow(world)
    world.graph.run_for(1.0)
    world.graph.publish("/path", Path())
    finished(world, probe, 1.0)
    world.graph.run_for(1.0)
    assert abs(world.plant.speed) <= 0.03
    assert world.state == "idle"


def test_the_footprint_is_published_while_it_is_subscribed_to(world: World) -> None:
    world.plant.pose = Pose2(1.0, 2.0, math.pi / 2)
    world.graph.run_for(0.3)
    probe = world.graph.collect("/local_costmap/published_footprint", PolygonStamped)
    world.graph.run_for(0.3)
    assert probe.last.header.frame_id == "map"
    corners = [(round(p.x, 6), round(p.y, 6)) for p in probe.last.polygon.points]
    assert corners == [(0.8, 2.25), (0.8, 1.75), (1.2, 1.75), (1.2, 2.25)]
