"""Nodes of Nav2's trees of Kilted and Lyrical: tracking, paths, lists of goals."""

import math
from pathlib import Path

import pytest
from py_trees.common import Status
from tree_robot import Planted

from navette.errors import FileFormatError
from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.nav2_msgs.srv import IsPathValid
from navette.msgs.nav_msgs.msg import Path as PathMsg
from navette.navigation.missions.tree.paths import tracking_error

RUNNING, SUCCESS, FAILURE = Status.RUNNING, Status.SUCCESS, Status.FAILURE


def pose(x: float, y: float = 0.0, yaw: float = 0.0) -> PoseStamped:
    msg = PoseStamped()
    msg.header.frame_id = "map"
    msg.pose.position.x, msg.pose.position.y = x, y
    msg.pose.orientation.z = math.sin(yaw / 2)
    msg.pose.orientation.w = math.cos(yaw / 2)
    return msg


def straight(length: int, yaw: float = 0.0) -> PathMsg:
    points = [(i * math.cos(yaw), i * math.sin(yaw)) for i in range(length + 1)]
    poses = [pose(x, y, yaw) for x, y in points]
    return PathMsg(header=poses[0].header, poses=poses)


@pytest.mark.parametrize("yaw", [0.0, 2.0, -math.pi / 2])
@pytest.mark.parametrize("left_m", [0.3, -0.3, 0.0])
def test_the_tracking_error_is_positive_to_the_left(yaw: float, left_m: float) -> None:
    robot = Pose2(
        2 * math.cos(yaw) - left_m * math.sin(yaw),
        2 * math.sin(yaw) + left_m * math.cos(yaw),
        yaw + 0.2,
    )
    error = tracking_error(straight(4, yaw), robot)
    assert error.position_tracking_error == pytest.approx(left_m, abs=1e-6)
    assert error.heading_tracking_error == pytest.approx(0.2)


def test_a_robot_beyond_the_bounds_fails_the_condition(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        "<ReactiveSequence>"
        '<IsWithinPathTrackingBounds tracking_feedback="{error}" max_error_left="0.4" '
        'max_error_right="0.2" max_error_heading="1.0"/>'
        '<FollowPath path="{path}" tracking_feedback="{error}"/>'
        "</ReactiveSequence>",
        path=straight(4),
    )
    assert tree.tick() is RUNNING  # nothing is known yet
    for here, status in (
        (Pose2(1.0, 0.3, 0.0), RUNNING),
        (Pose2(1.0, -0.3, 0.0), FAILURE),
        (Pose2(1.0, 0.5, 0.0), FAILURE),
        (Pose2(1.0, 0.0, 1.5), FAILURE),
        (Pose2(1.0, -0.1, -0.9), RUNNING),
    ):
        tree.halt()
        tree.board.set("error", None)
        tree.robot.here = here
        tree.tick()
        assert tree.tick() is status


def test_the_goal_is_near_when_little_of_the_path_is_left(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<IsGoalNearby path="{path}" proximity_threshold="1.5"/>',
        path=straight(4),
    )
    assert tree.tick() is FAILURE
    tree.robot.here = Pose2(3.1, 0.5, 0.0)
    assert tree.tick() is SUCCESS
    tree.board.set("path", PathMsg())
    assert tree.tick() is FAILURE


def test_a_robot_is_stopped_after_a_second_at_rest(tmp_path: Path) -> None:
    tree = Planted(tmp_path, '<CheckStopStatus duration_stopped="1000"/>')
    tree.robot.speed = (0.0, 0.2)
    assert tree.tick() is FAILURE
    tree.robot.speed = (0.0, 0.0)
    assert tree.tick(0.5) is RUNNING
    assert tree.tick(0.8) is RUNNING
    assert tree.tick(0.3) is SUCCESS


def test_a_validated_path_shows_where_it_collides(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<ValidatePath path="{path}" service_name="/other/is_path_valid" '
        'collision_poses="{hits}" stop_at_first_collision="false"/>',
        path=straight(4),
    )
    assert tree.tick() is RUNNING
    (call,) = tree.robot.calls
    assert call.name == "/other/is_path_valid"
    call.succeed(IsPathValid.Response(is_valid=False, invalid_pose_indices=[1, 3]))
    assert tree.tick() is FAILURE
    assert [hit.pose.position.x for hit in tree.board.get("hits")] == [1.0, 3.0]


def test_lists_of_goals_are_extended_and_shortened(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<SequenceStar><AppendGoalPoseToGoals goal_pose="{goal}" '
        'input_goals="{goals}" output_goals="{all}"/>'
        '<GetNextFewGoals input_goals="{all}" num_goals="2" output_goals="{next}"/>'
        "</SequenceStar>",
        goal=pose(9.0),
        goals=[pose(1.0), pose(2.0)],
    )
    assert tree.tick() is SUCCESS
    assert [g.pose.position.x for g in tree.board.get("all")] == [1.0, 2.0, 9.0]
    assert [g.pose.position.x for g in tree.board.get("next")] == [1.0, 2.0]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("<ComputeRoute/>", "ComputeRoute needs Nav2's route server"),
        (
            '<BackUp disable_collision_checks="true"/>',
            "expected false: true is not available",
        ),
    ],
)
def test_what_the_stack_lacks_is_named(tmp_path: Path, text: str, reason: str) -> None:
    with pytest.raises(FileFormatError, match=reason):
        Planted(tmp_path, text)
