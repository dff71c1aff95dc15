# SPDX-License-Identifier: Apache-2.0
"""The state of the simulation that sensors measure."""

from typing import NamedTuple

import mujoco

from navette.sim.contacts import ContactMonitor
from navette.sim.robot_state import RobotState


class Instant(NamedTuple):
    """One instant of a simulation; its kinematics are up to date."""

    model: mujoco.MjModel
    data: mujoco.MjData
    state: RobotState
    stamp_ns: int
    contacts: ContactMonitor
