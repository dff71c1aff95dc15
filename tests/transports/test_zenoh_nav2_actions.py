"""Nav2's actions from another context, over the network."""

from collections.abc import Iterator
from typing import Any

import pytest
from transport_pairs import until

from free_ports import free_endpoint
from navette import ActionClient, Context, Node
from navette.geometry import Pose2
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.geometry_msgs.msg import Point
from navette.msgs.nav2_msgs.action import BackUp, ComputePathToPose, FollowPath
from navette.msgs.nav2_msgs.srv import ClearEntireCostmap
from navette.navigation.stack.robot import simulate_robot
from navette.navigation.stack.stack import NavigationStack
from navette.runtime import Executor, PacedClock
from navette.runtime.stage.path_messages import pose_message
from navette.sim import World


class DistantStack:
    """The stack with a simulated robot in one context, a client in another."""

    def __init__(self, here: Context, there: Context) -> None:
        scene = World("room").add_walls((12.0, 12.0)).scene()
        self.sim = simulate_robot(scene, "jackal", start=Pose2(0, 0, 0), context=there)
        stack = NavigationStack.create(there)
        self.client = Node("client", context=here)
        self._executors = [Executor(context=here), Executor(context=there)]
        self._executors[0].add_node(self.client)
        for node in (self.sim, *stack.nodes):
            self._executors[1].add_node(node)
        there.check_overrides()

    @property
    def speed(self) -> float:
        return abs(float(self.sim.simulator.motion().linear[0]))

    @property
    def pose(self) -> Pose2:
        pose: Pose2 = self.sim.simulator.pose().to_pose2()
        return pose

    def until(self, condition: Any, what: str) -> None:
        def look() -> bool:
            near, far = self._executors
            far.spin_for(20_000_000)
            for _ in range(10):
                near.spin_once(timeout_sec=0.0)
            return bool(condition())

        until(look, what)

    def is_ready(self) -> bool:
        """Whether the map has been updated since the start."""
        return self.sim.get_clock().now().nanoseconds > 2_000_000_000

    def send(self, action: Any, name: str, goal: Any, feedback: Any = None) -> Any:
        client = ActionClient(self.client, action, name)
        self.until(client.server_is_ready, name)
        sent = client.send_goal_async(goal, feedback_callback=feedback)
        self.until(sent.done, "the goal's acceptance")
        handle: Any = sent.result()
        assert handle.accepted
        return handle

    def result(self, handle: Any) -> Any:
        future = handle.get_result_async()
        self.until(future.done, "the result")
        return future.result()


@pytest.fixture
def distant(monkeypatch: pytest.MonkeyPatch) -> Iterator[DistantStack]:
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())
    clock = PacedClock(4.0)
    with (
        Context(transport="zenoh") as here,
        Context(transport="zenoh", clock=clock) as there,
    ):
        yield DistantStack(here, there)


def test_plan_follow_cancel_back_up_and_clear(
    distant: DistantStack,
) -> None:
    goal = ComputePathToPose.Goal()
    goal.goal.header.frame_id = "map"
    goal.goal.pose = pose_message(Pose2(4.0, 1.0, 0.0))

    distant.until(distant.is_ready, "a map and a pose")
    handle = distant.send(ComputePathToPose, "compute_path_to_pose", goal)
    response = distant.result(handle)
    assert response.status == GoalStatus.STATUS_SUCCEEDED, response.result.error_msg
    path = response.result.path
    assert len(path.poses) > 10
    start = distant.pose
    feedback: list[Any] = []
    handle = distant.send(
        FollowPath, "follow_path", FollowPath.Goal(path=path), feedback.append
    )
    # Far enough to back up over what was seen: the laser does not see behind.
    distant.until(lambda: distant.pose.x - start.x > 0.5, "motion")
    handle.cancel_goal_async()
    response = distant.result(handle)
    assert response.status == GoalStatus.STATUS_CANCELED
    assert distant.speed < 0.05
    assert feedback[-1].feedback.distance_to_goal > 1.0

    goal = BackUp.Goal(target=Point(x=0.2), speed=0.3)
    response = distant.result(distant.send(BackUp, "backup", goal))
    assert response.status == GoalStatus.STATUS_SUCCEEDED
    assert distant.speed < 0.05
    name = "global_costmap/clear_entirely_global_costmap"
    client = distant.client.create_client(ClearEntireCostmap, name)
    distant.until(client.service_is_ready, name)
    future = client.call_async(ClearEntireCostmap.Request())
    distant.until(future.done, "the response")
