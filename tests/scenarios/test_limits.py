"""Control commands no more than the wheels transmit to the floor."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.control.node import ControlNode
from navette.navigation.control.params import ControlParams

from .conftest import MakeSimulation

STEP_S = 0.05


@pytest.mark.parametrize(
    "robot", ["course", "jackal", "husky", "turtlebot3_burger", "mecanum"]
)
def test_a_robot_that_brakes_and_turns_at_once_follows_its_commands(
    robot: str, simulate: MakeSimulation
) -> None:
    """Otherwise it stops later than control expects."""
    simulation = simulate(world="empty", robot=robot, start=Pose2(0, 0, 0), goals=())
    [control] = [n for n in simulation.context.nodes if isinstance(n, ControlNode)]
    limits: ControlParams = control.params
    simulator = simulation.sim.simulator
    turn = limits.max_turn_rate_radps / 2
    speed = limits.cruise_speed_mps
    for share in np.linspace(0.0, 1.0, 60):
        simulator.command(share * speed, share * turn)
        simulator.step(round(STEP_S / simulator.params.timestep_s))
    settled = simulator.motion()
    speed, turn_rate = speed, turn
    late, turns_late = 0.0, 0.0
    while speed > 0.0 or turn_rate > -turn:
        speed = max(0.0, speed - limits.deceleration_mps2 * STEP_S)
        turn_rate = max(-turn, turn_rate - limits.turn_acceleration_radps2 * STEP_S)
        simulator.command(speed, turn_rate)
        simulator.step(round(STEP_S / simulator.params.timestep_s))
        motion = simulator.motion()
        late = max(late, motion.linear[0] - speed)
        turns_late = max(turns_late, motion.angular[2] - turn_rate)
    assert settled.linear[0] == pytest.approx(limits.cruise_speed_mps, rel=0.03)
    assert late < 0.06
    assert turns_late < math.radians(6)
