"""Run control: pause, step, reset and rate by services; results do not change."""

import math
from typing import Any

import pytest

from navette.msgs.geometry_msgs.msg import PoseWithCovarianceStamped, Twist, Vector3
from navette.msgs.nav2_msgs.srv import ClearEntireCostmap
from navette.msgs.rosbag2_interfaces.srv import GetRate, SetRate
from navette.msgs.simulation_interfaces.msg import Result, SimulationState
from navette.msgs.simulation_interfaces.srv import (
    GetSimulationState,
    ResetSimulation,
    SetSimulationState,
    StepSimulation,
)
from navette.msgs.std_msgs.msg import Empty
from navette.msgs.std_srvs.srv import Empty as EmptySrv
from navette.runtime import (
    ContextClock,
    PacedClock,
    Parameter,
    SystemClock,
    VirtualClock,
)
from navette.runtime.testing import GraphHarness
from navette.sim import Scene, load_robot, load_world
from navette.sim.node import SimNode

MS = 10**6
PLAYING, PAUSED = SimulationState.STATE_PLAYING, SimulationState.STATE_PAUSED


def _scene() -> Scene:
    return load_world("course").with_robot(load_robot("course").model)


class Run:
    """A simulation that drives in a circle, and a caller of its services."""

    def __init__(
        self, clock: ContextClock | None = None, localization: str = "truth"
    ) -> None:
        self.graph = GraphHarness(clock=clock or VirtualClock())
        located = [Parameter("localization", value=localization)]
        self.sim = self.graph.add(
            SimNode(_scene(), context=self.graph.context, parameter_overrides=located)
        )
        publisher = self.graph.node.create_publisher(Twist, "/cmd_vel", 10)
        command = Twist(linear=Vector3(x=0.5), angular=Vector3(z=0.4))
        self.graph.node.create_timer(0.1, lambda: publisher.publish(command))

    def call(self, name: str, kind: Any, **fields: Any) -> Any:
        client = self.graph.node.create_client(kind, f"/sim/{name}")
        future = client.call_async(kind.Request(**fields))
        self.graph.executor.spin_for(0)
        assert future.done()
        return future.result()

    def set_state(self, state: int) -> Result:
        target = SimulationState(state=state)
        response = self.call("set_simulation_state", SetSimulationState, state=target)
        result: Result = response.result
        return result

    def state(self) -> int:
        response = self.call("get_simulation_state", GetSimulationState)
        return int(response.state.state)

    def step(self, steps: int) -> Result:
        result: Result = self.call(
            "step_simulation", StepSimulation, steps=steps
        ).result
        return result

    def spin_ms(self, duration: int) -> None:
        self.graph.executor.spin_for(duration * MS)

    @property
    def pose(self) -> tuple[float, ...]:
        pose = self.sim.simulator.pose()
        return (*pose.translation, *pose.rotation)


def test_pauses_and_steps_do_not_change_the_result() -> None:
    plain, stepped = Run(), Run()
    plain.spin_ms(1500)
    stepped.spin_ms(700)
    assert stepped.set_state(PAUSED).result == Result.RESULT_OK
    assert stepped.state() == PAUSED
    for _ in range(3):
        assert stepped.step(10).result == Result.RESULT_OK
        stepped.spin_ms(100)
    assert stepped.graph.now_ns == 1000 * MS
    assert stepped.set_state(PLAYING).result == Result.RESULT_OK
    stepped.spin_ms(500)
    assert stepped.graph.now_ns == plain.graph.now_ns
    assert stepped.pose == plain.pose
    assert plain.pose[0] != 0.0


def test_only_a_paused_simulation_is_stepped() -> None:
    run = Run()
    refused = run.step(1)
    assert refused.result == Result.RESULT_INCORRECT_STATE
    assert "paused" in refused.error_message
    run.set_state(PAUSED)
    assert run.step(0).result == Result.RESULT_OPERATION_FAILED
    assert "expected 1 to 6000" in run.step(2**63).error_message


def test_a_state_that_holds_already_or_is_unknown_is_refused() -> None:
    run = Run()
    already = SetSimulationState.Response.ALREADY_IN_TARGET_STATE
    assert run.set_state(PLAYING).result == already
    assert run.set_state(9).result == Result.RESULT_FEATURE_UNSUPPORTED
    assert run.state() == PLAYING


def test_reset_returns_the_robot_to_its_start_and_time_continues() -> None:
    run = Run()
    start = run.pose
    run.spin_ms(1000)
    assert run.pose != start
    response = run.call("reset_simulation", ResetSimulation)
    assert response.result.result == Result.RESULT_OK
    assert run.pose == pytest.approx(start, abs=1e-3)
    assert run.graph.now_ns == 1000 * MS
    response = run.call("reset_simulation", ResetSimulation, scope=255)
    assert response.result.result == Result.RESULT_FEATURE_UNSUPPORTED


def test_after_a_reset_goal_estimate_and_maps_are_new() -> None:
    run = Run()
    seen = list[str]()

    def clear(request: Any, response: Any) -> Any:
        seen.append("cleared")
        return response

    def on_pose(msg: PoseWithCovarianceStamped) -> None:
        seen.append("pose")
        place = msg.pose.pose.position
        assert (place.x, place.y) == pytest.approx(start[:2], abs=1e-3)
        assert msg.header.frame_id == "map"
        assert msg.pose.covariance[35] > 0.0

    node = run.graph.node
    node.create_service(ClearEntireCostmap, "/some/clear_entirely", clear)
    node.create_subscription(
        Empty, "/cancel_goal", lambda _: seen.append("canceled"), 10
    )
    node.create_subscription(PoseWithCovarianceStamped, "/initialpose", on_pose, 10)
    start = run.pose
    run.spin_ms(1000)
    assert seen == []
    run.call("reset_simulation", ResetSimulation)
    run.spin_ms(200)
    assert seen == ["canceled", "pose"]
    run.spin_ms(200)
    assert seen == ["canceled", "pose", "cleared"], "when the estimate is in use"
    run.spin_ms(1000)
    assert len(seen) == 3


def test_after_a_reset_slam_begins_a_new_map_and_gets_no_pose() -> None:
    run = Run(localization="slam")
    seen = list[str]()

    def restart(request: Any, response: Any) -> Any:
        seen.append("restarted")
        return response

    run.graph.node.create_service(EmptySrv, "/slam/restart", restart)
    run.graph.node.create_subscription(
        PoseWithCovarianceStamped, "/initialpose", lambda _: seen.append("pose"), 10
    )
    run.spin_ms(1000)
    run.call("reset_simulation", ResetSimulation)
    run.spin_ms(500)
    assert seen == ["restarted"]


def test_stopped_is_paused_at_the_start() -> None:
    run = Run()
    start = run.pose
    run.spin_ms(1000)
    assert run.set_state(SimulationState.STATE_STOPPED).result == Result.RESULT_OK
    assert run.pose == pytest.approx(start, abs=1e-3)
    assert run.state() == PAUSED


def test_the_rate_of_a_paced_run_changes() -> None:
    run = Run(PacedClock(2.0))
    assert run.call("get_rate", GetRate).rate == 2.0
    assert run.call("set_rate", SetRate, rate=8.0).success
    assert run.call("get_rate", GetRate).rate == 8.0
    for rate in (0.0, -1.0, math.nan, math.inf, 1e6):
        assert not run.call("set_rate", SetRate, rate=rate).success
    fastest = Run()
    assert fastest.call("get_rate", GetRate).rate == math.inf
    assert not fastest.call("set_rate", SetRate, rate=1.0).success


def test_without_virtual_time_nothing_is_paused() -> None:
    run = Run(SystemClock())
    refused = run.set_state(PAUSED)
    assert refused.result == Result.RESULT_FEATURE_UNSUPPORTED
