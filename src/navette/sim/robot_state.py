# SPDX-License-Identifier: Apache-2.0
"""Pose, motion, wheels and links of the robot in MuJoCo's state."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.geometry import Transform3, Vector3
from navette.geometry.se3 import rotate
from navette.sim.build import RobotIndex
from navette.sim.scene import JointKind, Model


class Motion(NamedTuple):
    """Velocity of the base in its own frame: m/s and rad/s."""

    linear: Vector3
    angular: Vector3


class JointReadings(NamedTuple):
    """Joints with their angles (rad) and speeds (rad/s), each (N,)."""

    names: tuple[str, ...]
    angles: NDArray[np.float64]
    speeds: NDArray[np.float64]


class RobotState:
    """Reads the robot's state from MuJoCo's arrays; writes only its start pose."""

    def __init__(self, robot: RobotIndex, data: mujoco.MjData) -> None:
        self._robot = robot
        self._data = data
        # Views: MuJoCo never moves its arrays.
        self._root = data.qpos[robot.qpos : robot.qpos + 7]
        self._root_speed = data.qvel[robot.qvel : robot.qvel + 6]
        self._root_T_base = robot.root_T_model @ robot.model_T_base
        self._base_T_root = self._root_T_base.inverse()
        self._direction = np.array([wheel.direction for wheel in robot.wheels])
        self._slide = np.array([wheel.slide for wheel in robot.wheels])
        self._left = np.array([wheel.side > 0 for wheel in robot.wheels])

    def pose(self) -> Transform3:
        """``world_T_base`` of the axle midpoint on the floor."""
        return self._root_pose() @ self._root_T_base

    def place(self, world_T_base: Transform3) -> None:
        pose = world_T_base @ self._base_T_root
        x, y, z, w = pose.rotation
        self._root[:] = (*pose.translation, w, x, y, z)

    def motion(self) -> Motion:
        """Velocity of the base in its own frame."""
        v_world, omega_root = self._root_velocity()
        x, y, z, w = self._root_pose().rotation
        v_root = rotate((-x, -y, -z, w), v_world)
        lever = cross(omega_root, self._root_T_base.translation)
        at_base = (v_root[0] + lever[0], v_root[1] + lever[1], v_root[2] + lever[2])
        base_R_root = self._base_T_root.rotation
        return Motion(rotate(base_R_root, at_base), rotate(base_R_root, omega_root))

    def point_velocity(self, p_world: Vector3) -> tuple[Vector3, Vector3]:
        """Velocity of the body's point at ``p_world`` and angular velocity, world."""
        (vx, vy, vz), omega_root = self._root_velocity()
        pose = self._root_pose()
        omega = rotate(pose.rotation, omega_root)
        (px, py, pz), (x, y, z) = p_world, pose.translation
        ax, ay, az = cross(omega, (px - x, py - y, pz - z))
        return (vx + ax, vy + ay, vz + az), omega

    def wheel_travel(self) -> tuple[float, float]:
        """Mean forward rotation of the left and the right wheels (rad)."""
        angles = self._data.qpos[self._robot.wheel_qpos] * self._direction
        return float(angles[self._left].mean()), float(angles[~self._left].mean())

    def wheel_slide(self) -> float:
        """Rotation (rad) of mecanum wheels that moves the base to the left."""
        angles = self._data.qpos[self._robot.wheel_qpos] * self._direction
        return -float((angles * self._slide).mean())

    def wheel_joints(self) -> JointReadings:
        """Angles and speeds of the drive wheels' joints."""
        robot = self._robot
        return JointReadings(
            tuple(wheel.joint for wheel in robot.wheels),
            self._data.qpos[robot.wheel_qpos],
            self._data.qvel[robot.wheel_qvel],
        )

    def link_in_base(self, name: str) -> Transform3:
        """Pose of a link in the base frame (kinematics must be up to date)."""
        body = self._robot.bodies[name]
        w, x, y, z = self._data.xquat[body].tolist()
        px, py, pz = self._data.xpos[body].tolist()
        return self.pose().inverse() @ Transform3((px, py, pz), (x, y, z, w))

    def _root_pose(self) -> Transform3:
        x, y, z, qw, qx, qy, qz = self._root.tolist()
        return Transform3((x, y, z), (qx, qy, qz, qw))

    def _root_velocity(self) -> tuple[Vector3, Vector3]:
        """Velocity of a free joint: linear in the world, angular in the root frame."""
        vx, vy, vz, wx, wy, wz = self._root_speed.tolist()
        return (vx, vy, vz), (wx, wy, wz)


def moving_links(model: Model) -> tuple[str, ...]:
    """Links that move relative to the base: all beyond a movable joint."""
    moving: list[str] = []
    for _ in model.joints:
        for joint in model.joints:
            beyond = joint.kind is not JointKind.FIXED or joint.parent in moving
            if beyond and joint.child not in moving:
                moving.append(joint.child)
    return tuple(moving)


def cross(a: Vector3, b: Vector3) -> Vector3:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )
