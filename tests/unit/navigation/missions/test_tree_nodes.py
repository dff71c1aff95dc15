"""Semantics of the tree nodes: BehaviorTree.CPP v4's and Nav2's."""

from pathlib import Path
from typing import Any

import pytest
from py_trees.common import Status
from tree_robot import Planted

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.nav2_msgs.action import ComputePathToPose, FollowPath, Spin
from navette.msgs.nav_msgs.msg import Path as PathMsg

RUNNING, SUCCESS, FAILURE = Status.RUNNING, Status.SUCCESS, Status.FAILURE


def pose(x: float, y: float = 0.0) -> PoseStamped:
    msg = PoseStamped()
    msg.header.frame_id = "map"
    msg.pose.position.x, msg.pose.position.y = x, y
    return msg


def path(*xs: float) -> PathMsg:
    msg = PathMsg()
    msg.header.frame_id = "map"
    msg.poses = [pose(x) for x in xs]
    return msg


def wait(name: str) -> str:
    return f'<Wait server_name="{name}"/>'


def test_a_sequence_resumes_and_a_reactive_one_starts_again(tmp_path: Path) -> None:
    tree = Planted(tmp_path, f"<Sequence>{wait('a')}{wait('b')}</Sequence>")
    assert tree.tick() is RUNNING
    tree.robot.calls[0].succeed()
    assert tree.tick() is RUNNING
    assert tree.tick() is RUNNING
    assert tree.robot.names == ["a", "b"]
    tree.robot.calls[1].succeed()
    assert tree.tick() is SUCCESS

    tree = Planted(
        tmp_path,
        '<ReactiveSequence><InitialPoseReceived initial_pose_received="{known}"/>'
        f"{wait('b')}</ReactiveSequence>",
        known=True,
    )
    assert tree.tick() is RUNNING
    tree.board.set("known", False)
    assert tree.tick() is FAILURE
    assert tree.robot.calls[0].cancelled


def test_a_fallback_tries_the_next_and_a_reactive_one_checks_again(
    tmp_path: Path,
) -> None:
    tree = Planted(tmp_path, f"<Fallback>{wait('a')}{wait('b')}</Fallback>")
    tree.tick()
    tree.robot.calls[0].fail()
    assert tree.tick() is RUNNING
    tree.robot.calls[1].succeed()
    assert tree.tick() is SUCCESS

    tree = Planted(
        tmp_path,
        f"<ReactiveFallback><GoalUpdated/>{wait('b')}</ReactiveFallback>",
        goal=pose(1.0),
    )
    assert tree.tick() is RUNNING
    assert tree.tick() is RUNNING
    tree.board.set("goal", pose(2.0))
    assert tree.tick() is SUCCESS
    assert tree.robot.calls[0].cancelled


def test_a_sequence_with_memory_repeats_only_the_failed_child(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<RetryUntilSuccessful num_attempts="3"><SequenceWithMemory>'
        f"{wait('a')}{wait('b')}</SequenceWithMemory></RetryUntilSuccessful>",
    )
    tree.tick()
    tree.robot.calls[0].succeed()
    tree.tick()
    tree.robot.calls[1].fail()
    assert tree.tick() is RUNNING
    assert tree.tick() is RUNNING
    assert tree.robot.names == ["a", "b", "b"]


def test_parallel_counts_successes_and_failures(tmp_path: Path) -> None:
    three = f"{wait('a')}{wait('b')}{wait('c')}"
    tree = Planted(tmp_path, f'<Parallel success_count="2">{three}</Parallel>')
    assert tree.tick() is RUNNING
    tree.robot.calls[0].succeed()
    assert tree.tick() is RUNNING
    tree.robot.calls[2].succeed()
    assert tree.tick() is SUCCESS
    assert tree.robot.calls[1].cancelled

    tree = Planted(tmp_path, f'<Parallel failure_count="2">{three}</Parallel>')
    tree.tick()
    tree.robot.calls[0].fail()
    # Not all three can succeed any more.
    assert tree.tick() is FAILURE


def test_inverter_and_forced_results(tmp_path: Path) -> None:
    for text, status in (
        ("<Inverter><AlwaysSuccess/></Inverter>", FAILURE),
        ("<Inverter><AlwaysFailure/></Inverter>", SUCCESS),
        ("<ForceSuccess><AlwaysFailure/></ForceSuccess>", SUCCESS),
        ("<ForceFailure><AlwaysSuccess/></ForceFailure>", FAILURE),
        (f"<Inverter>{wait('a')}</Inverter>", RUNNING),
        (
            "<KeepRunningUntilFailure><AlwaysSuccess/></KeepRunningUntilFailure>",
            RUNNING,
        ),
        (
            "<KeepRunningUntilFailure><AlwaysFailure/></KeepRunningUntilFailure>",
            FAILURE,
        ),
        ('<Repeat num_cycles="0"><AlwaysFailure/></Repeat>', SUCCESS),
        ("<SingleTrigger><AlwaysSuccess/></SingleTrigger>", SUCCESS),
    ):
        assert Planted(tmp_path, text).tick() is status, text


def test_repeat_retry_timeout_and_delay(tmp_path: Path) -> None:
    tree = Planted(tmp_path, '<Repeat num_cycles="3"><AlwaysSuccess/></Repeat>')
    assert [tree.tick() for _ in range(3)] == [RUNNING, RUNNING, SUCCESS]
    tree = Planted(
        tmp_path,
        '<RetryUntilSuccessful num_attempts="2"><AlwaysFailure/>'
        "</RetryUntilSuccessful>",
    )
    assert [tree.tick() for _ in range(2)] == [RUNNING, FAILURE]
    tree = Planted(tmp_path, f'<Timeout msec="1500">{wait("a")}</Timeout>')
    assert [tree.tick(1.0) for _ in range(3)] == [RUNNING, RUNNING, FAILURE]
    assert tree.robot.calls[0].cancelled
    tree = Planted(tmp_path, '<Delay delay_msec="500"><AlwaysSuccess/></Delay>')
    assert [tree.tick(), tree.tick(0.4), tree.tick(0.1)] == [RUNNING, RUNNING, SUCCESS]


def test_a_pipeline_ticks_earlier_children_while_a_later_one_runs(
    tmp_path: Path,
) -> None:
    tree = Planted(
        tmp_path,
        '<PipelineSequence><RateController hz="1.0">'
        '<ComputePathToPose goal="{goal}" path="{path}" error_code_id="{code}"/>'
        '</RateController><FollowPath path="{path}"/></PipelineSequence>',
        goal=pose(5.0),
    )
    robot = tree.robot
    assert tree.tick() is RUNNING
    assert robot.names == ["compute_path_to_pose"]
    robot.calls[0].succeed(ComputePathToPose.Result(path=path(0.0, 5.0)))
    assert tree.tick(0.1) is RUNNING
    assert robot.names[1:] == ["follow_path"]
    for _ in range(9):
        tree.tick(0.1)
    assert len(robot.calls) == 2
    tree.tick(0.1)
    assert robot.names[2:] == ["compute_path_to_pose"]
    # While it plans again, the robot still follows; then the new path replaces the old.
    assert not robot.calls[1].cancelled
    robot.calls[2].succeed(ComputePathToPose.Result(path=path(1.0, 5.0)))
    tree.tick(0.1)
    assert robot.names[3:] == ["follow_path"]
    assert robot.calls[3].goal.path == path(1.0, 5.0)
    robot.calls[3].succeed(FollowPath.Result())
    assert tree.tick(0.1) is SUCCESS


def test_a_recovery_runs_between_attempts(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        f'<RecoveryNode number_of_retries="2">{wait("try")}{wait("help")}'
        "</RecoveryNode>",
    )
    robot = tree.robot
    tree.tick()
    for number in range(2):
        robot.calls[-1].fail()
        assert tree.tick() is RUNNING
        assert robot.names[-1] == "help"
        robot.calls[-1].succeed()
        assert tree.tick() is RUNNING
        assert robot.names == ["try", *["help", "try"] * (number + 1)]
    robot.calls[-1].fail()
    assert tree.tick() is FAILURE


def test_a_recovery_that_fails_ends_the_attempts(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<RecoveryNode number_of_retries="5"><AlwaysFailure/><AlwaysFailure/>'
        "</RecoveryNode>",
    )
    assert tree.tick() is FAILURE


def test_round_robin_continues_with_the_next_recovery(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<RecoveryNode number_of_retries="9"><AlwaysFailure/>'
        f"<RoundRobin>{wait('a')}{wait('b')}{wait('c')}</RoundRobin></RecoveryNode>",
    )
    for _ in range(4):
        assert tree.tick() is RUNNING
        tree.robot.calls[-1].succeed()
    assert tree.robot.names == ["a", "b", "c", "a"]


def test_recoveries_are_counted(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<Sequence><ClearEntireCostmap service_name="clear"/><Spin/>'
        '<Spin is_recovery="false"/><Wait/></Sequence>',
    )
    for _ in range(4):
        tree.tick()
        tree.robot.calls[-1].succeed()
    assert tree.tick() is SUCCESS
    assert tree.board.get("number_recoveries") == 3


def test_distance_speed_and_goal_decide_when_to_plan_again(tmp_path: Path) -> None:
    def planned(tree: Planted) -> int:
        tree.tick()
        for call in tree.robot.calls:
            call.succeed()
        tree.tick()
        return len(tree.robot.calls)

    inside = f"{wait('plan')}"
    distance = Planted(
        tmp_path, f'<DistanceController distance="1.0">{inside}</DistanceController>'
    )
    assert planned(distance) == 1
    distance.robot.here = Pose2(0.9, 0.0, 0.0)
    assert planned(distance) == 1
    distance.robot.here = Pose2(1.1, 0.0, 0.0)
    assert planned(distance) == 2

    speed = Planted(
        tmp_path,
        '<SpeedController min_rate="0.1" max_rate="1.0" min_speed="0" max_speed="0.5">'
        f"{inside}</SpeedController>",
        goal=pose(1.0),
    )
    speed.robot.speed = (0.5, 0.0)
    assert planned(speed) == 1
    speed.robot.wait(1.0)
    assert planned(speed) == 2
    speed.board.set("goal", pose(2.0))
    assert planned(speed) == 3

    goal = Planted(
        tmp_path,
        f"<GoalUpdatedController>{inside}</GoalUpdatedController>",
        goal=pose(1.0),
    )
    assert planned(goal) == 1
    assert planned(goal) == 1
    goal.board.set("goal", pose(2.0))
    assert planned(goal) == 2


def test_error_codes_decide_whether_a_recovery_helps(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<Sequence><ForceSuccess><ComputePathToPose goal="{goal}" '
        'error_code_id="{code}"/></ForceSuccess>'
        '<WouldAPlannerRecoveryHelp error_code="{code}"/>'
        '<AreErrorCodesPresent error_code="{code}" error_codes_to_check="208;999"/>'
        "</Sequence>",
        goal=pose(1.0),
    )
    for code, status in ((208, SUCCESS), (207, FAILURE), (206, FAILURE)):
        tree.tick()
        tree.robot.calls[-1].fail(ComputePathToPose.Result(error_code=code))
        assert tree.tick() is status, code


def test_a_missing_server_has_the_code_unknown(tmp_path: Path) -> None:
    tree = Planted(tmp_path, '<Spin error_code_id="{code}"/>')
    tree.tick()
    tree.robot.calls[0].fail(None, "no action server /spin; start its node")
    assert tree.tick() is FAILURE
    assert tree.board.get("code") == Spin.Result.UNKNOWN
    assert tree.root.feedback_message == "no action server /spin; start its node"


def test_time_distance_and_path_conditions(tmp_path: Path) -> None:
    timer = Planted(tmp_path, '<TimeExpired seconds="2"/>')
    assert [timer.tick(1.0) for _ in range(4)] == [FAILURE, FAILURE, SUCCESS, FAILURE]
    trip = Planted(tmp_path, '<DistanceTraveled distance="2"/>')
    assert trip.tick() is FAILURE
    trip.robot.here = Pose2(0.0, 2.1, 0.0)
    assert [trip.tick(), trip.tick()] == [SUCCESS, FAILURE]
    old = Planted(tmp_path, '<PathExpiringTimer seconds="2" path="{path}"/>')
    old.board.set("path", path(1.0))
    assert [old.tick(), old.tick(1.5)] == [FAILURE, FAILURE]
    old.board.set("path", path(2.0))
    assert [old.tick(1.5), old.tick(1.5), old.tick(1.5)] == [FAILURE, FAILURE, SUCCESS]
    frames = Planted(tmp_path, '<TransformAvailable parent="map" child="base"/>')
    assert frames.tick() is FAILURE
    frames.robot.transforms.add(("map", "base"))
    assert frames.tick() is SUCCESS


def test_paths_and_goals_are_cut(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<Sequence><TruncatePath distance="2" input_path="{path}" output_path="{cut}"/>'
        '<GetPoseFromPath path="{path}" index="-1" pose="{last}"/>'
        '<RemovePassedGoals radius="1.5" input_goals="{goals}" output_goals="{goals}"/>'
        "</Sequence>",
        path=path(0.0, 1.0, 2.0, 3.0, 4.0),
        goals=[pose(1.0), pose(0.5), pose(5.0), pose(0.2)],
    )
    assert tree.tick() is SUCCESS
    assert [p.pose.position.x for p in tree.board.get("cut").poses] == [0.0, 1.0, 2.0]
    assert tree.board.get("last").pose.position.x == 4.0
    assert [p.pose.position.x for p in tree.board.get("goals")] == [5.0, 0.2]


def test_a_selector_takes_the_newest_message(tmp_path: Path) -> None:
    from navette.msgs.std_msgs.msg import String

    tree = Planted(
        tmp_path,
        '<PlannerSelector selected_planner="{chosen}" default_planner="GridBased" '
        'topic_name="planner_selector"/>',
    )
    assert tree.tick() is SUCCESS
    assert tree.board.get("chosen") == "GridBased"
    tree.robot.messages["planner_selector"] = String(data="Other")
    tree.tick()
    assert tree.board.get("chosen") == "Other"


def test_a_leaf_without_its_input_fails_with_the_reason(tmp_path: Path) -> None:
    tree = Planted(tmp_path, '<FollowPath path="{path}"/>')
    assert tree.tick() is FAILURE
    assert "{path} has no value" in tree.root.feedback_message
    assert tree.robot.calls == []


def test_navigate_names_its_failure_and_follows_a_new_goal(tmp_path: Path) -> None:
    tree = Planted(tmp_path, "<Navigate/>", goal=pose(1.0))
    tree.tick()
    tree.board.set("goal", pose(2.0))
    assert tree.tick() is RUNNING
    assert [call.goal for call in tree.robot.calls] == [pose(1.0), pose(2.0)]
    assert not tree.robot.calls[0].cancelled
    tree.robot.calls[1].fail("stuck", "goal (2, 0): stuck")
    assert tree.tick() is FAILURE
    found: dict[str, Any] = {name: tree.board.get(name) for name in tree.board}
    assert found["failure"] == "stuck"
    assert found["navigate_error_code"] == FollowPath.Result.FAILED_TO_MAKE_PROGRESS


@pytest.mark.parametrize("status", [RUNNING, SUCCESS])
def test_a_halted_tree_starts_again(tmp_path: Path, status: Status) -> None:
    tree = Planted(tmp_path, f"<Sequence>{wait('a')}{wait('b')}</Sequence>")
    tree.tick()
    for call in tree.robot.calls:
        call.succeed()
    tree.tick()
    if status is SUCCESS:
        tree.robot.calls[1].succeed()
        assert tree.tick() is SUCCESS
    tree.halt()
    assert tree.robot.calls[1].cancelled is (status is RUNNING)
    tree.tick()
    assert tree.robot.names == ["a", "b", "a"]


def test_a_switch_ticks_the_child_of_the_equal_case(tmp_path: Path) -> None:
    tree = Planted(
        tmp_path,
        '<Switch2 variable="{mode}" case_1="dock" case_2="{other}">'
        f"{wait('a')}{wait('b')}{wait('c')}</Switch2>",
        mode="dock",
        other=7,
    )
    assert tree.tick() is RUNNING
    assert tree.robot.names == ["a"]
    tree.board.set("mode", "7")
    assert tree.tick() is RUNNING
    assert tree.robot.names == ["a", "b"]
    assert tree.robot.calls[0].cancelled
    tree.robot.calls[1].fail()
    assert tree.tick() is FAILURE
    tree.board.set("mode", "elsewhere")
    assert tree.tick() is RUNNING
    assert tree.robot.names == ["a", "b", "c"]
    tree.robot.calls[2].succeed()
    assert tree.tick() is SUCCESS
