# SPDX-License-Identifier: Apache-2.0
"""Velocity of the base to the controls of MuJoCo's actuators."""

import mujoco

from navette.sim.build import RobotIndex
from navette.sim.drive import BodySpeed, rim_speed
from navette.sim.scene import AckermannDrive
from navette.sim.steering import steering_angles


class DriveOutputs:
    """Sets the speeds of the wheels, and the angles of steered ones."""

    def __init__(self, robot: RobotIndex, data: mujoco.MjData) -> None:
        self._robot = robot
        self._ctrl = data.ctrl  # a view: MuJoCo never moves it
        self._wheels = list(zip(robot.wheels, robot.actuators.tolist(), strict=True))

    def set(self, speed: BodySpeed) -> None:
        """Write the controls of a velocity of the base."""
        robot, ctrl = self._robot, self._ctrl
        drive, radius = robot.drive, robot.drive.wheel_radius
        rims = []
        for wheel, actuator in self._wheels:
            rim = rim_speed(wheel, drive, speed)
            rims.append(rim)
            ctrl[actuator] = wheel.direction * rim / radius
        if robot.steering is not None:
            assert isinstance(drive, AckermannDrive)
            ctrl[list(robot.steering)] = steering_angles(drive, speed.steering)
        if len(robot.traction):
            ctrl[robot.traction] = rims
