"""Failures stop the robot: lost sensors, nodes that raise."""

import math
from typing import Any, NoReturn

import numpy as np
import pytest

from navette.errors import CallbackError
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.stack.monitor import LATCHED
from navette.navigation.stack.simulation import Simulation

from .conftest import MakeSimulation

SECOND = 1_000_000_000
STOP_WITHIN_NS = SECOND // 2
WHEN_FAST = 5 * SECOND
GOALS_X = {"course": 12.0, "jackal": 8.0, "husky": 12.0, "turtlebot3_burger": 3.0}


def driving(simulate: MakeSimulation, robot: str) -> Simulation:
    """A robot at speed in free space."""
    simulation = simulate(world="empty", robot=robot, goals=((GOALS_X[robot], 0.0),))
    simulation.executor.spin_until(WHEN_FAST)
    assert speed(simulation) > 0.15
    return simulation


def speed(simulation: Simulation) -> float:
    motion = simulation.sim.simulator.motion()
    return math.hypot(motion.linear[0], motion.linear[1])


@pytest.mark.slow
@pytest.mark.parametrize("robot", GOALS_X)
@pytest.mark.parametrize("topic", ["/lidar", "/odom/filtered"])
def test_a_lost_sensor_stops_the_robot_within_half_a_second(
    simulate: MakeSimulation, monkeypatch: pytest.MonkeyPatch, robot: str, topic: str
) -> None:
    simulation = driving(simulate, robot)
    hand_over = simulation.sim.hand_over
    monkeypatch.setattr(
        simulation.sim,
        "hand_over",
        lambda name, msg: None if name == topic else hand_over(name, msg),
    )
    simulation.executor.spin_for(STOP_WITHIN_NS)
    assert speed(simulation) < 0.02


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["course", "husky"])
def test_lost_scans_do_not_stop_the_robot(
    simulate: MakeSimulation, monkeypatch: pytest.MonkeyPatch, robot: str
) -> None:
    simulation = driving(simulate, robot)
    hand_over = simulation.sim.hand_over
    rng = np.random.default_rng(5)
    lost: list[bool] = []

    def lossy(name: str, msg: Any) -> None:
        if name == "/lidar":
            # One in ten, never three in a row, now and then two.
            lost.append(bool(rng.random() < 0.1) and lost[-2:] != [True, True])
            if lost[-1]:
                return
        hand_over(name, msg)

    monkeypatch.setattr(simulation.sim, "hand_over", lossy)
    slowest = 1.0
    for _ in range(80):
        simulation.executor.spin_for(SECOND // 20)
        slowest = min(slowest, speed(simulation))
    assert [True, True] in [lost[i : i + 2] for i in range(len(lost))]
    assert sum(lost) >= len(lost) // 20
    assert slowest > 0.3


@pytest.mark.slow
def test_a_node_that_raises_is_named_and_the_robot_stopped(
    simulate: MakeSimulation,
) -> None:
    simulation = driving(simulate, "course")
    monitor = simulation.monitor

    def fail(scan: LaserScan) -> NoReturn:
        raise ZeroDivisionError("broken on purpose")

    monitor.create_subscription(LaserScan, "/lidar", fail, 10)
    with pytest.raises(CallbackError) as caught:
        simulation.run()
    assert caught.value.node == "/monitor"
    assert caught.value.source == "topic /lidar"
    assert caught.value.stamp_ns == pytest.approx(WHEN_FAST, abs=SECOND // 5)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    assert speed(simulation) < 0.01


@pytest.mark.slow
def test_the_map_is_published_before_the_robot_moves_and_for_late_subscribers(
    simulate: MakeSimulation,
) -> None:
    simulation = simulate(world="arena")
    maps: list[OccupancyGrid] = []
    simulation.executor.spin_until(SECOND)
    assert speed(simulation) < 0.01
    simulation.monitor.create_subscription(OccupancyGrid, "/map", maps.append, LATCHED)
    simulation.executor.spin_for(SECOND // 100)
    assert maps
    assert (np.asarray(maps[-1].data) >= 0).sum() > 1000
