# SPDX-License-Identifier: Apache-2.0
"""Pose of a sensor on its body."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.geometry import Transform3


class Mount:
    """A pose fixed to a MuJoCo body."""

    def __init__(self, body: int, body_T_sensor: Transform3) -> None:
        self.body = body
        self.body_T_sensor = body_T_sensor
        self._offset = np.array(body_T_sensor.translation)
        self._rotation = rotation_matrix(body_T_sensor)

    def world(
        self, data: mujoco.MjData
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Position (3,) m and rotation (3, 3) ``world_R_sensor``."""
        world_R_body = data.xmat[self.body].reshape(3, 3)
        position = data.xpos[self.body] + world_R_body @ self._offset
        return position, world_R_body @ self._rotation

    def pose(self, data: mujoco.MjData) -> Transform3:
        """Return ``world_T_sensor``."""
        w, x, y, z = data.xquat[self.body].tolist()
        px, py, pz = data.xpos[self.body].tolist()
        return Transform3((px, py, pz), (x, y, z, w)) @ self.body_T_sensor


def rotation_matrix(pose: Transform3) -> NDArray[np.float64]:
    """(3, 3) matrix of the pose's quaternion."""
    x, y, z, w = pose.rotation
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, np.array([w, x, y, z]))
    return matrix.reshape(3, 3)
