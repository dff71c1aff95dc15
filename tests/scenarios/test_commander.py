"""BasicNavigator drives the whole stack, as programs written for Nav2 do."""

import math

import pytest

from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.ros2.packages.nav2_simple_commander import BasicNavigator, TaskResult

from .conftest import MakeSimulation


def pose(x: float, y: float, yaw: float = 0.0) -> PoseStamped:
    msg = PoseStamped()
    msg.header.frame_id = "map"
    msg.pose.position.x, msg.pose.position.y = x, y
    msg.pose.orientation.z, msg.pose.orientation.w = (
        math.sin(yaw / 2),
        math.cos(yaw / 2),
    )
    return msg


def wait(navigator: BasicNavigator) -> TaskResult:
    for _ in range(3000):  # of 0.1 s
        if navigator.isTaskComplete():
            return navigator.getResult()
    raise AssertionError(f"no result: {navigator.getFeedback()}")


@pytest.mark.slow
def test_a_pose_is_driven_to_and_a_task_cancelled(simulate: MakeSimulation) -> None:
    simulation = simulate(world="arena")
    navigator = BasicNavigator(context=simulation.context)
    assert navigator.goToPose(pose(2.0, 1.0, 1.57))
    assert wait(navigator) is TaskResult.SUCCEEDED
    assert navigator.getFeedback().distance_remaining < 0.5
    here = simulation.sim.simulator.pose().to_pose2()
    assert math.dist((here.x, here.y), (2.0, 1.0)) < 0.5
    assert abs(here.yaw - 1.57) < 0.3

    assert navigator.goToPose(pose(-3.0, -3.0))
    for _ in range(20):
        assert not navigator.isTaskComplete()
    navigator.cancelTask()
    assert wait(navigator) is TaskResult.CANCELED
    motion = simulation.sim.simulator.motion()
    assert math.hypot(*motion.linear) < 0.03
    assert simulation.sim.simulator.contacts.count == 0


@pytest.mark.slow
def test_poses_are_driven_through(simulate: MakeSimulation) -> None:
    simulation = simulate(world="arena")
    navigator = BasicNavigator(context=simulation.context)
    navigator.waitUntilNav2Active()  # the simulated time advances meanwhile
    route = [pose(2.0, 0.0), pose(2.0, 2.0, 1.57), pose(3.5, 3.5)]
    assert navigator.goThroughPoses(route)
    assert wait(navigator) is TaskResult.SUCCEEDED
    path = navigator.getPath(pose(0.0, 0.0), pose(2.0, 0.0), use_start=True)
    assert path is not None
    assert len(path.poses) > 10
    assert simulation.sim.simulator.contacts.count == 0


@pytest.mark.slow
@pytest.mark.parametrize(("x", "y", "yaw"), [(2.0, 1.0, 1.57), (1.0, -1.0, -2.5)])
def test_a_precise_goal_is_reached_within_centimetres(
    simulate: MakeSimulation, x: float, y: float, yaw: float
) -> None:
    simulation = simulate(world="arena", robot="jackal")
    navigator = BasicNavigator(context=simulation.context)
    assert navigator.goToPose(pose(x, y, yaw), behavior_tree="precise")
    assert wait(navigator) is TaskResult.SUCCEEDED
    here = simulation.sim.simulator.pose().to_pose2()
    assert math.dist((here.x, here.y), (x, y)) <= 0.06
    assert abs(math.remainder(here.yaw - yaw, math.tau)) <= 0.07
    assert simulation.sim.simulator.contacts.count == 0
