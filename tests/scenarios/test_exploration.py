"""Exploration: the whole of an unknown room is mapped, and the end has a reason."""

import pytest

from navette.msgs.std_msgs.msg import Empty
from navette.navigation.stack.exploring import add_explorer
from navette.sim import World

from .conftest import MakeSimulation


@pytest.mark.long
def test_two_rooms_are_mapped(simulate: MakeSimulation) -> None:
    world = World("two rooms").add_walls((9.0, 6.0))
    # A wall between the rooms with a door of 2 m.
    world.add_box((0.5, -1.0), (0.2, 4.0))
    simulation = simulate(
        scene=world.scene(), robot="turtlebot3_burger", max_time_s=300.0
    )
    node = add_explorer(simulation)
    simulation.run()
    report = node.report
    assert report.reason == "complete"
    assert report.coverage == 1.0
    # 9 m by 6 m without walls.
    assert 42.0 < report.free_m2 < 54.0
    assert report.failed <= 2
    assert report.path_length_m > 1.0
    assert simulation.summary().contacts == 0


@pytest.mark.slow
def test_an_exploration_ends_when_its_goal_is_cancelled(
    simulate: MakeSimulation,
) -> None:
    simulation = simulate(world="arena", max_time_s=60.0)
    node = add_explorer(simulation)
    simulation.executor.spin_until(5_000_000_000)
    assert not node.done
    simulation.stack.missions.on_cancel_goal(Empty())
    simulation.run()
    assert node.report.reason == "canceled"


def test_an_exploration_can_be_interrupted(simulate: MakeSimulation) -> None:
    simulation = simulate(world="arena", max_time_s=60.0)
    node = add_explorer(simulation)
    simulation.executor.spin_until(2_000_000_000)
    assert node.report.goals == 1
    simulation.close()  # no callback of the active goal raises
    assert not node.done
