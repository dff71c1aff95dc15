"""The stack follows the names that a robot has for its topics."""

import pytest

from navette.errors import UnknownNameError
from navette.navigation.stack.robot import simulate_robot
from navette.navigation.stack.simulation import Simulation
from navette.runtime import Context, VirtualClock

from .conftest import MakeSimulation

STACK_NAMES = {"/lidar", "/odom/filtered"}


def topics_of(simulation: Simulation) -> set[str]:
    return set(simulation.context.graph.topics())


@pytest.mark.slow
def test_the_burger_drives_on_scan_and_odom(simulate: MakeSimulation) -> None:
    simulation = simulate(
        world="empty", robot="burger", goals=((1.0, 0.5),), max_time_s=60.0
    )
    assert topics_of(simulation) >= {"/scan", "/odom", "/imu", "/joint_states"}
    assert not topics_of(simulation) & STACK_NAMES
    simulation.run()
    assert simulation.summary().succeeded


def test_other_robots_have_the_names_of_the_stack(simulate: MakeSimulation) -> None:
    for robot in ("course", "jackal", "husky"):
        simulation = simulate(world="empty", robot=robot)
        assert topics_of(simulation) >= STACK_NAMES


def test_a_burger_beside_a_program_has_its_names() -> None:
    with Context(clock=VirtualClock()) as context:
        simulate_robot("empty", "burger", context=context)
        topics = set(context.graph.topics())
    assert topics >= {"/scan", "/odom", "/cmd_vel"}
    assert not topics & STACK_NAMES


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["jackal", "husky"])
def test_clearpaths_robots_drive_with_their_names_of_ros1(
    simulate: MakeSimulation, robot: str
) -> None:
    simulation = simulate(
        world="empty", robot=f"{robot}:ros1", goals=((2.0, 0.5),), max_time_s=60.0
    )
    topics = topics_of(simulation)
    assert topics >= {"/front/scan", "/odometry/filtered", "/imu/data", "/cmd_vel"}
    assert not topics & STACK_NAMES
    simulation.run()
    assert simulation.summary().succeeded


def test_unknown_names_of_a_robot_are_an_error(simulate: MakeSimulation) -> None:
    expected = "topic names of jackal 'ros2'; known: ros1"
    with pytest.raises(UnknownNameError, match=expected):
        simulate(world="empty", robot="jackal:ros2")
