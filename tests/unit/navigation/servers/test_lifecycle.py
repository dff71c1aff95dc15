"""Lifecycle of the stages under Nav2's names, and the lifecycle manager."""

import math
from collections.abc import Iterator
from typing import Any

import pytest

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.geometry_msgs.msg import PointStamped
from navette.msgs.lifecycle_msgs.msg import Transition, TransitionEvent
from navette.msgs.lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetState
from navette.msgs.nav2_msgs.action import ComputePathToPose, FollowPath, NavigateToPose
from navette.msgs.nav2_msgs.srv import ManageLifecycleNodes
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.std_srvs.srv import Trigger
from navette.navigation.servers.lifecycle import NAV2_NODES
from navette.navigation.servers.lifecycle_plan import next_transition, state_of_command
from navette.navigation.stack.robot import simulate_robot
from navette.navigation.stack.stack import NavigationStack
from navette.runtime.stage.path_messages import pose_message
from navette.runtime.testing import GraphHarness
from navette.sim import World

Command = ManageLifecycleNodes.Request
MANAGED = (
    "map_server",
    "controller_server",
    "smoother_server",
    "planner_server",
    "behavior_server",
    "bt_navigator",
)


class DrivingStack:
    """The stack with a simulated Jackal in an empty room."""

    def __init__(self, graph: GraphHarness) -> None:
        self.graph = graph
        scene = World("room").add_walls((14.0, 14.0)).scene()
        sim = simulate_robot(
            scene, "jackal", start=Pose2(0, 0, 0), context=graph.context
        )
        graph.add(sim)
        stack = NavigationStack.create(graph.context)
        for node in stack.nodes:
            graph.add(node)
        self.odometry = graph.collect("/odom/filtered", Odometry)
        graph.run_for(1.0)

    def state(self, name: str) -> str:
        response = self.graph.call(GetState, f"{name}/get_state", GetState.Request())
        return str(response.current_state.label)

    def manage(self, command: int) -> bool:
        request = Command(command=command)
        name = "lifecycle_manager_navigation/manage_nodes"
        return bool(self.graph.call(ManageLifecycleNodes, name, request).success)

    def is_active(self) -> bool:
        name = "lifecycle_manager_navigation/is_active"
        return bool(self.graph.call(Trigger, name, Trigger.Request()).success)

    def navigate(self, x: float, y: float) -> Any:
        goal = NavigateToPose.Goal()
        goal.pose.header.frame_id = "map"
        goal.pose.pose = pose_message(Pose2(x, y, 0.0))
        return self.graph.send_goal(NavigateToPose, "navigate_to_pose", goal)

    @property
    def speed(self) -> float:
        return abs(float(self.odometry.last.twist.twist.linear.x))


@pytest.fixture
def stack() -> Iterator[DrivingStack]:
    with GraphHarness() as graph:
        yield DrivingStack(graph)


def test_programs_of_nav2_find_active_nodes(stack: DrivingStack) -> None:
    for name in NAV2_NODES:
        assert stack.state(name) == "active", name
    assert stack.is_active()
    states = stack.graph.call(
        GetAvailableStates,
        "bt_navigator/get_available_states",
        GetAvailableStates.Request(),
    )
    assert "finalized" in [state.label for state in states.available_states]


def test_pause_stops_the_robot_and_refuses_goals_until_resume(
    stack: DrivingStack,
) -> None:
    driving = stack.navigate(5.0, 0.0)
    assert stack.graph.run_until(lambda: stack.speed > 0.4, 20.0)
    events = stack.graph.collect("/controller_server/transition_event", TransitionEvent)
    assert stack.manage(Command.PAUSE)
    assert stack.graph.run_until(lambda: driving.done, 5.0)
    assert driving.status == GoalStatus.STATUS_ABORTED
    assert [event.goal_state.label for event in events.messages] == [
        "deactivating",
        "inactive",
    ]
    stack.graph.run_for(1.0)
    assert stack.speed < 0.02
    assert not stack.is_active()
    assert {stack.state(name) for name in MANAGED} == {"inactive"}
    for probe in (
        stack.navigate(5.0, 0.0),
        stack.graph.send_goal(FollowPath, "follow_path", FollowPath.Goal()),
        stack.graph.send_goal(
            ComputePathToPose, "compute_path_to_pose", ComputePathToPose.Goal()
        ),
    ):
        assert stack.graph.run_until(lambda p=probe: p.done, 2.0)
        assert probe.accepted is False
    point = PointStamped()
    point.header.frame_id = "map"
    point.point.x = 5.0
    stack.graph.publish("/goal_point", point)
    stack.graph.run_for(3.0)
    assert stack.speed < 0.02
    assert stack.manage(Command.RESUME)
    assert stack.is_active()
    again = stack.navigate(3.0, 0.0)
    assert stack.graph.run_until(lambda: again.done, 40.0)
    assert again.status == GoalStatus.STATUS_SUCCEEDED


def test_shutdown_reset_and_startup(stack: DrivingStack) -> None:
    for command, state in (
        (Command.RESET, "unconfigured"),
        (Command.CONFIGURE, "inactive"),
        (Command.STARTUP, "active"),
        (Command.CLEANUP, "unconfigured"),
        (Command.SHUTDOWN, "finalized"),
        (Command.PAUSE, "finalized"),
        (Command.STARTUP, "active"),
    ):
        assert stack.manage(command)
        assert {stack.state(name) for name in MANAGED} == {state}
    probe = stack.navigate(2.0, 0.0)
    assert stack.graph.run_until(lambda: probe.done, 40.0)
    assert probe.status == GoalStatus.STATUS_SUCCEEDED


def test_one_node_can_be_deactivated(stack: DrivingStack) -> None:
    request = ChangeState.Request(transition=Transition(label="deactivate"))
    name = "controller_server/change_state"
    assert stack.graph.call(ChangeState, name, request).success
    assert not stack.graph.call(ChangeState, name, request).success
    assert stack.state("controller_server") == "inactive"
    assert stack.state("planner_server") == "active"
    stack.navigate(5.0, 0.0)
    stack.graph.run_for(3.0)
    assert stack.speed < 0.02
    activate = ChangeState.Request(transition=Transition(label="activate"))
    assert stack.graph.call(ChangeState, name, activate).success
    assert stack.graph.run_until(lambda: stack.speed > 0.3, 30.0)


def test_a_missing_node_is_not_active() -> None:
    from navette.navigation.servers.lifecycle_manager import LifecycleManagerNode

    with GraphHarness() as graph:
        graph.add(LifecycleManagerNode(context=graph.context))
        name = "lifecycle_manager_navigation/is_active"
        response = graph.call(Trigger, name, Trigger.Request())
        assert not response.success
        assert "bt_navigator: unavailable" in response.message
        request = Command(command=Command.STARTUP)
        name = "lifecycle_manager_navigation/manage_nodes"
        assert not graph.call(ManageLifecycleNodes, name, request).success
        unknown = Command(command=99)
        assert not graph.call(ManageLifecycleNodes, name, unknown).success


def test_every_state_leads_to_every_goal() -> None:
    after = {1: "inactive", 2: "unconfigured", 3: "active", 4: "inactive"}
    after |= {5: "finalized", 6: "finalized", 7: "finalized"}
    for command in range(7):
        goal = state_of_command(command)
        for state in ("unconfigured", "inactive", "active", "finalized"):
            if (goal, state) == ("unconfigured", "finalized"):
                continue
            for _ in range(4):
                step = next_transition(state, goal)
                if step is None:
                    break
                state = after[step]
            assert next_transition(state, goal) is None
    with pytest.raises(InvalidValueError, match="no transition from unavailable"):
        next_transition("unavailable", "active")
    assert math.isfinite(command)
