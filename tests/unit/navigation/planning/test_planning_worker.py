"""The planner while its worker computes a plan, with a paced clock."""

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from planner_graph import World
from planning_worlds import fill

from navette.geometry import Pose2
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.action_msgs.srv import CancelGoal
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.nav2_msgs.action import ComputePathToPose
from navette.msgs.std_msgs.msg import Empty
from navette.navigation.planning.navigator import Navigator
from navette.navigation.planning.planner import Goal, Plan, Planner
from navette.runtime.clock import PacedClock
from navette.runtime.stage.path_messages import pose_message
from navette.runtime.testing import GraphHarness

WAIT_S = 30.0


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness(clock=PacedClock(factor=50.0)) as harness:
        yield harness


class LongPlan:
    """The next plan takes until :attr:`end` is set; ``meanwhile`` runs in the loop."""

    def __init__(
        self,
        graph: GraphHarness,
        monkeypatch: pytest.MonkeyPatch,
        meanwhile: Callable[[], object],
    ) -> None:
        self.end = threading.Event()
        self.was_held = False
        usual = Planner.plan
        waiting = [meanwhile]

        def plan(planner: Planner, *args: Any, **options: Any) -> Plan:
            if waiting:
                graph.context.loop.call_soon_threadsafe(waiting.pop())
                self.was_held = not self.end.wait(WAIT_S)
            return usual(planner, *args, **options)

        monkeypatch.setattr(Planner, "plan", plan)


def test_a_goal_is_cancelled_while_its_path_is_computed(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World(graph).ready()
    long = LongPlan(graph, monkeypatch, lambda: graph.publish("/cancel_goal", Empty()))
    graph.node.create_subscription(
        DiagnosticStatus,
        "/planner/status",
        lambda msg: msg.message == "canceled" and long.end.set(),
        10,
    )
    world.send(8.0, 4.0)
    graph.run_for(3.0)
    assert not long.was_held
    assert world.message == "canceled"
    assert all(not path.poses for path in world.paths.messages)


def test_a_new_goal_replaces_the_plan_under_way(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World(graph).ready()

    long = LongPlan(graph, monkeypatch, lambda: world.send(3.0, 6.0))
    usual = Navigator.set_goal

    def set_goal(navigator: Navigator, goal: Goal, now_ns: int) -> None:
        usual(navigator, goal, now_ns)
        if goal.x == 3.0:
            long.end.set()

    monkeypatch.setattr(Navigator, "set_goal", set_goal)
    world.send(8.0, 4.0)
    graph.run_for(3.0)
    assert not long.was_held
    assert [len(path.poses) > 0 for path in world.paths.messages] == [True]
    assert world.last_path()[-1, :2].tolist() == [3.0, 6.0]


def test_a_map_that_arrives_meanwhile_is_used_by_the_next_plan(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World(graph).ready()

    def send() -> None:
        fill(world.occupancy, world.spec, (4.5, 5.5), (2.0, 6.0))
        world.send_map()
        graph.context.loop.call_soon(long.end.set)

    long = LongPlan(graph, monkeypatch, send)
    world.send(8.0, 4.0)
    graph.run_for(3.0)
    assert not long.was_held
    direct, around = world.paths.messages
    assert len(around.poses) > len(direct.poses)


def test_a_request_is_cancelled_while_its_path_is_computed(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch
) -> None:
    World(graph).ready()
    goal = PoseStamped(pose=pose_message(Pose2(8.0, 4.0, 0.0)))
    goal.header.frame_id = "map"
    request = ComputePathToPose.Goal(goal=goal)
    cancel = graph.node.create_client(
        CancelGoal, "compute_path_to_pose/_action/cancel_goal"
    )
    all_goals = CancelGoal.Request()
    long = LongPlan(graph, monkeypatch, lambda: cancel.call_async(all_goals))
    probe = graph.send_goal(ComputePathToPose, "compute_path_to_pose", request)
    assert graph.run_until(lambda: probe.done, 5.0)
    long.end.set()
    assert probe.status == GoalStatus.STATUS_CANCELED
    # The server accepts the next request.
    again = graph.send_goal(ComputePathToPose, "compute_path_to_pose", request)
    assert graph.run_until(lambda: again.done, 5.0)
    assert again.status == GoalStatus.STATUS_SUCCEEDED
