"""Nav2's navigation actions of the mission node, against a scripted planner."""

from collections.abc import Iterator
from pathlib import Path as FilePath
from typing import Any

import pytest

from navette.msgs import get_interface
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from navette.msgs.geometry_msgs.msg import PointStamped, PoseStamped
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.std_srvs.srv import Trigger
from navette.navigation.missions.node import MissionNode
from navette.runtime import Parameter
from navette.runtime.action import ActionClient
from navette.runtime.testing import GraphHarness
from navette.runtime.time import ns_to_stamp

SUCCEEDED = GoalStatus.STATUS_SUCCEEDED
CANCELED = GoalStatus.STATUS_CANCELED
ABORTED = GoalStatus.STATUS_ABORTED


class FakeRobot:
    """Planner and wheels: drives to a goal in two seconds, or fails as scripted."""

    def __init__(self, graph: GraphHarness) -> None:
        self._graph = graph
        self.results: list[str] = []
        self.goals: list[tuple[float, float]] = []
        self.cancelled = 0
        self.speed = 0.0
        self.braking_s = 0.5
        self._left_s = 0.0
        self._active = False
        node = graph.node
        node.create_subscription(PoseStamped, "/planner/goal_pose", self._take, 10)
        node.create_service(Trigger, "/planner/cancel", self._cancel)
        node.create_timer(0.1, self._step)

    def _take(self, msg: PoseStamped) -> None:
        self.goals.append((msg.pose.position.x, msg.pose.position.y))
        self._active, self._left_s = True, 2.0
        self._report("following")

    def _cancel(self, request: Any, response: Any) -> Any:
        self.cancelled += 1
        self._active = False
        self._report("canceled")
        return response

    def _step(self) -> None:
        if self._active:
            self.speed, self._left_s = 0.5, self._left_s - 0.1
            if self._left_s <= 0.0:
                self._active, self.speed = False, 0.0
                self._report(self.results.pop(0) if self.results else "reached")
        elif self.speed:
            self.speed = max(0.0, self.speed - 0.1 * 0.5 / self.braking_s)
        msg = Odometry(child_frame_id="base_link")
        msg.header.frame_id = "map"
        msg.header.stamp = ns_to_stamp(self._graph.now_ns)
        msg.twist.twist.linear.x = self.speed
        self._graph.publish("/odom/filtered", msg)

    def _report(self, message: str) -> None:
        result = "" if message == "following" else message
        status = DiagnosticStatus(message=message)
        status.values = [
            KeyValue(key="goal_id", value=str(len(self.goals))),
            KeyValue(key="result", value=result),
        ]
        self._graph.publish("/planner/status", status, latched=True)


class Commander:
    """A client of the actions that keeps feedback and results."""

    def __init__(self, graph: GraphHarness) -> None:
        self._graph = graph
        self._clients: dict[str, ActionClient] = {}
        self.feedback: list[Any] = []

    def send(self, name: str, **fields: Any) -> "Sent":
        kind = "".join(word.title() for word in name.split("_"))
        action = get_interface(f"nav2_msgs/action/{kind}")
        if name not in self._clients:
            self._clients[name] = ActionClient(self._graph.node, action, name)
        keep = self.feedback.append
        future = self._clients[name].send_goal_async(
            action.Goal(**fields), lambda message: keep(message.feedback)
        )
        assert self._graph.run_until(future.done, 2.0)
        return Sent(self._graph, future.result())


class Sent:
    """A goal that was sent."""

    def __init__(self, graph: GraphHarness, handle: Any) -> None:
        self._graph, self.handle = graph, handle
        assert handle.accepted
        self._future = handle.get_result_async()

    @property
    def done(self) -> bool:
        return bool(self._future.done())

    def cancel(self) -> None:
        self.handle.cancel_goal_async()

    def status_and_result(self, timeout_s: float = 30.0) -> tuple[int, Any]:
        assert self._graph.run_until(self._future.done, timeout_s)
        response: Any = self._future.result()
        return response.status, response.result


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


@pytest.fixture
def robot(graph: GraphHarness) -> FakeRobot:
    return FakeRobot(graph)


@pytest.fixture
def commander(graph: GraphHarness) -> Commander:
    return Commander(graph)


def mission(graph: GraphHarness, **params: object) -> MissionNode:
    overrides = [Parameter(name, value=value) for name, value in params.items()]
    return graph.add(MissionNode(context=graph.context, parameter_overrides=overrides))


def pose(x: float, y: float = 0.0) -> PoseStamped:
    msg = PoseStamped()
    msg.header.frame_id = "map"
    msg.pose.position.x, msg.pose.position.y = x, y
    return msg


def test_a_goal_is_driven_to_with_feedback(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    graph.run_for(0.5)
    status, result = commander.send(
        "navigate_to_pose", pose=pose(3.0)
    ).status_and_result()
    assert (status, result.error_code) == (SUCCEEDED, result.NONE)
    assert robot.goals == [(3.0, 0.0)]
    last = commander.feedback[-1]
    assert last.distance_remaining == pytest.approx(3.0)
    assert 1.0 < last.navigation_time.sec + last.navigation_time.nanosec / 1e9 <= 2.2
    assert last.estimated_time_remaining.sec == 6
    assert last.current_pose.header.frame_id == "map"


@pytest.mark.parametrize(
    ("failure", "code"),
    [
        ("no_path", 208),
        ("goal_blocked", 206),
        ("goal_outside_map", 204),
        ("goal_orientation_invalid", 200),
    ],
)
def test_a_failure_has_nav2s_code_and_the_reason(
    graph: GraphHarness,
    robot: FakeRobot,
    commander: Commander,
    failure: str,
    code: int,
) -> None:
    mission(graph)
    robot.results = [failure]
    sent = commander.send("navigate_to_pose", pose=pose(3.0))
    status, result = sent.status_and_result()
    assert (status, result.error_code) == (ABORTED, code)
    assert failure in result.error_msg
    assert "(3, 0)" in result.error_msg


def test_a_cancelled_goal_ends_when_the_robot_is_at_rest(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    sent = commander.send("navigate_to_pose", pose=pose(3.0))
    graph.run_for(1.0)
    assert robot.speed == 0.5
    sent.cancel()
    graph.run_for(0.05)
    assert robot.cancelled == 1
    assert not sent.done
    status, _ = sent.status_and_result()
    assert status == CANCELED
    assert robot.speed == 0.0


def test_a_new_goal_replaces_the_one_under_way_without_a_stop(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    first = commander.send("navigate_to_pose", pose=pose(3.0))
    graph.run_for(1.0)
    second = commander.send("navigate_to_pose", pose=pose(5.0))
    status, result = first.status_and_result()
    assert status == ABORTED
    assert "newer goal" in result.error_msg
    assert robot.cancelled == 0
    assert second.status_and_result()[0] == SUCCEEDED
    assert robot.goals == [(3.0, 0.0), (5.0, 0.0)]


def test_goals_of_people_become_goals_of_the_action(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    graph.run_for(0.2)
    point = PointStamped()
    point.header.frame_id = "map"
    point.point.x = 2.0
    graph.publish("/goal_point", point)
    graph.run_for(0.2)
    assert robot.goals == [(2.0, 0.0)]
    graph.publish("/goal_pose", pose(4.0))
    graph.run_for(0.2)
    assert robot.goals[1:] == [(4.0, 0.0)]
    cancel = get_interface("action_msgs/srv/CancelGoal")
    client = graph.node.create_client(cancel, "navigate_to_pose/_action/cancel_goal")
    future = client.call_async(cancel.Request())
    assert graph.run_until(future.done, 1.0)
    assert len(future.result().goals_canceling) == 1
    graph.run_for(3.0)
    assert robot.cancelled == 1
    assert robot.speed == 0.0


def test_goals_are_driven_through_in_order(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    graph.run_for(0.2)
    sent = commander.send(
        "navigate_through_poses", poses=[pose(2.0), pose(4.0), pose(6.0)]
    )
    assert sent.status_and_result()[0] == SUCCEEDED
    assert robot.goals == [(2.0, 0.0), (4.0, 0.0), (6.0, 0.0)]
    left = [each.number_of_poses_remaining for each in commander.feedback]
    assert sorted(set(left), reverse=True) == [3, 2, 1]
    assert left == sorted(left, reverse=True)


def test_waypoints_are_followed_and_missed_ones_reported(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    robot.results = ["reached", "no_path", "reached"]
    sent = commander.send("follow_waypoints", poses=[pose(2.0), pose(4.0), pose(6.0)])
    status, result = sent.status_and_result()
    assert status == SUCCEEDED
    (missed,) = result.missed_waypoints
    assert (missed.index, missed.error_code) == (1, 208)
    assert [each.current_waypoint for each in commander.feedback] == [0, 1, 2]


def test_waypoints_loop_and_begin_where_asked(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    poses = [pose(2.0), pose(4.0)]
    sent = commander.send(
        "follow_waypoints", poses=poses, number_of_loops=1, goal_index=1
    )
    assert sent.status_and_result()[0] == SUCCEEDED
    assert robot.goals == [(4.0, 0.0), (2.0, 0.0), (4.0, 0.0)]


def test_cancelled_waypoints_stop_the_robot_first(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    sent = commander.send("follow_waypoints", poses=[pose(2.0), pose(4.0)])
    graph.run_for(1.0)
    sent.cancel()
    assert sent.status_and_result()[0] == CANCELED
    assert robot.speed == 0.0
    assert robot.goals == [(2.0, 0.0)]


def test_a_click_ends_the_following_of_waypoints(
    graph: GraphHarness, robot: FakeRobot, commander: Commander
) -> None:
    mission(graph)
    sent = commander.send("follow_waypoints", poses=[pose(2.0), pose(4.0)])
    graph.run_for(1.0)
    graph.publish("/goal_pose", pose(9.0))
    status, result = sent.status_and_result()
    assert status == ABORTED
    assert "newer goal" in result.error_msg
    graph.run_for(5.0)
    assert robot.goals == [(2.0, 0.0), (9.0, 0.0)]


@pytest.mark.parametrize("name", ["navigate_through_poses", "follow_waypoints"])
def test_no_goals_are_refused(
    graph: GraphHarness, robot: FakeRobot, commander: Commander, name: str
) -> None:
    mission(graph)
    status, result = commander.send(name, poses=[]).status_and_result()
    assert status == ABORTED
    assert "no poses" in result.error_msg


def test_a_list_of_goals_ends_when_it_is_cancelled(
    graph: GraphHarness, robot: FakeRobot
) -> None:
    node = mission(graph, goals_m=[2.0, 0.0, 4.0, 0.0], wait_for_map=False)
    graph.run_for(1.5)
    assert node.active_goal == (2.0, 0.0)
    cancel = get_interface("action_msgs/srv/CancelGoal")
    client = graph.node.create_client(cancel, "navigate_to_pose/_action/cancel_goal")
    client.call_async(cancel.Request())
    assert graph.run_until(lambda: node.done, 5.0)
    assert [o.result for o in node.outcomes] == ["canceled", "skipped"]


def test_a_goal_names_its_tree(
    graph: GraphHarness, robot: FakeRobot, commander: Commander, tmp_path: FilePath
) -> None:
    mission(graph)
    tree = tmp_path / "tree.xml"
    tree.write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="T"><Navgate/></BehaviorTree></root>'
    )
    sent = commander.send("navigate_to_pose", pose=pose(1.0), behavior_tree=str(tree))
    status, result = sent.status_and_result()
    assert status == ABORTED
    assert "tree.xml:1" in result.error_msg
    assert "did you mean Navigate?" in result.error_msg
    tree.write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="T"><AlwaysSuccess/></BehaviorTree>'
        "</root>"
    )
    sent = commander.send("navigate_to_pose", pose=pose(1.0), behavior_tree=str(tree))
    assert sent.status_and_result()[0] == SUCCEEDED
    assert robot.goals == []
