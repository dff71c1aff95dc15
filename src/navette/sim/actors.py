# SPDX-License-Identifier: Apache-2.0
"""Models that follow a script: their poses in the physics."""

import mujoco
import numpy as np

from navette.geometry import Transform3, quaternion_from_yaw
from navette.sim.build import Compiled
from navette.sim.model_builder import actor_name
from navette.sim.scene import Model
from navette.sim.trajectory import ScriptedPose


class Actors:
    """Sets the poses of scripted models as a function of time alone."""

    def __init__(self, compiled: Compiled) -> None:
        self._motions = [
            (model, model.motion, compiled.mocap_of(actor_name(model)))
            for model in compiled.scene.models
            if model.motion is not None
        ]
        self._indices = np.array([index for _, _, index in self._motions], np.int64)
        self._fastest_mps = max(
            (motion.fastest_mps() for _, motion, _ in self._motions), default=0.0
        )

    def __bool__(self) -> bool:
        return bool(self._motions)

    @property
    def fastest_mps(self) -> float:
        """Upper bound of the speed of any of them."""
        return self._fastest_mps

    def place(self, data: mujoco.MjData, now_ns: int) -> None:
        """Set all poses for a time."""
        if not self._motions:
            return
        poses = [motion.at(now_ns / 1e9) for _, motion, _ in self._motions]
        values = np.array(poses)
        data.mocap_pos[self._indices] = values[:, :3]
        half = values[:, 3] / 2
        data.mocap_quat[self._indices] = 0.0
        data.mocap_quat[self._indices, 0] = np.cos(half)
        data.mocap_quat[self._indices, 3] = np.sin(half)

    def jump_within(self, now_ns: int, span_ns: int) -> bool:
        """Return whether a script starts again, elsewhere, within a span of time."""
        return any(
            motion.jumps_within(now_ns / 1e9, span_ns / 1e9)
            for _, motion, _ in self._motions
        )

    def poses(self, now_ns: int) -> list[tuple[Model, Transform3]]:
        """Return each model with its pose in the world at a time."""
        return [
            (model, _transform(motion.at(now_ns / 1e9)))
            for model, motion, _ in self._motions
        ]


def _transform(pose: ScriptedPose) -> Transform3:
    return Transform3(pose[:3], quaternion_from_yaw(pose.yaw))
