"""The stack drives with the filter's pose instead of the simulator's."""

import math

import pytest

from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.localization.ekf.node import EkfNode
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.stack.stack import NavigationStack
from navette.runtime import Context, Executor, Parameter, VirtualClock
from navette.sim.node import SimNode

GOAL = (12.0, 0.0)
ORDER = "x y z roll pitch yaw vx vy vz vroll vpitch vyaw ax ay az".split()


def config(*names: str) -> list[bool]:
    return [name in names for name in ORDER]


def filter_for(sim: SimNode, context: Context) -> EkfNode:
    frames = {
        "odom_frame": sim.params.odom_frame,
        "world_frame": sim.params.odom_frame,
        "base_link_frame": sim.params.base_frame,
    }
    inputs = {
        "odom0": "/wheels/odometry",
        "odom0_config": config("vx", "vy", "vyaw"),
        "imu0": "/imu",
        "imu0_config": config("yaw", "vyaw"),
    }
    start = {"initial_state": [-6.0, *[0.0] * 14]}
    values = {**frames, **inputs, **start, "frequency_hz": 20.0}
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    return EkfNode(context=context, parameter_overrides=overrides)


@pytest.mark.slow
def test_the_robot_drives_by_filtered_wheels_and_imu() -> None:
    """22 m around an obstacle, with wheels whose slip accumulates."""
    resolved = resolve_scene(RunOptions(world="course"))
    context = Context(clock=VirtualClock())
    with context:
        resolved.override_parameters(context.overrides)
        context.overrides.add("missions", {"goals_m": list(GOAL)}, "test")
        noisy = {
            "localization": "odometry+imu",
            "wheel_noise_m": 0.02,
            "odometry_child_frame": "",
        }
        context.overrides.add("sim", noisy, "test")
        sim = SimNode(resolved.scene, context=context)
        ekf = filter_for(sim, context)
        stack = NavigationStack.create(context)
        executor = Executor(context=context)
        off: list[float] = []

        def on_estimate(estimate: Odometry) -> None:
            x, y, _ = sim.simulator.pose().translation
            place = estimate.pose.pose.position
            off.append(math.hypot(place.x - x, place.y - y))

        ekf.create_subscription(Odometry, "/odom/filtered", on_estimate, 10)
        for node in context.nodes:
            executor.add_node(node)
        stack.missions.on_done = executor.stop
        executor.spin_until(90_000_000_000)
        results = [goal.result for goal in stack.missions.all_outcomes]
        assert results == ["reached"]
        assert sim.simulator.contacts.count == 0
        assert len(off) > 300
        assert max(off) < 0.25
