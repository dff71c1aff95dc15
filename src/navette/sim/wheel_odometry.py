# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning by wheel encoders: drifts as wheels slip and sensors err."""

import math

import numpy as np

from navette.geometry import Pose2
from navette.sim.scene import DiffDrive


class WheelOdometry:
    """Integrates the turns of the wheels along circular arcs.

    Each side's measured travel has a random relative error, whose variance grows
    with the distance: after a metre its standard deviation is ``noise`` metres.
    """

    def __init__(self, drive: DiffDrive, *, noise: float) -> None:
        self._drive = drive
        self._noise = noise
        self.reset(Pose2(0.0, 0.0, 0.0), (0.0, 0.0))

    def reset(self, pose: Pose2, wheels: tuple[float, float]) -> None:
        """Start at a pose with the encoders at these angles (rad)."""
        self.pose = pose
        self._wheels = wheels
        self._stamp_ns = 0
        self.speed = 0.0
        self.yaw_rate = 0.0

    def update(
        self, wheels: tuple[float, float], stamp_ns: int, rng: np.random.Generator
    ) -> Pose2:
        """Pose after the encoders moved to ``wheels`` (left, right; rad)."""
        radius = self._drive.wheel_radius
        left = self._measured((wheels[0] - self._wheels[0]) * radius, rng)
        right = self._measured((wheels[1] - self._wheels[1]) * radius, rng)
        self._wheels = wheels
        travel = (left + right) / 2
        turn = (right - left) / self._drive.wheel_separation
        # Chord of the arc: along the mean heading, shorter by sinc(turn / 2).
        half = turn / 2
        chord = travel * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
        step = Pose2(chord * math.cos(half), chord * math.sin(half), turn)
        self.pose = self.pose @ step
        seconds = (stamp_ns - self._stamp_ns) * 1e-9
        if seconds > 0:
            self.speed, self.yaw_rate = travel / seconds, turn / seconds
        self._stamp_ns = stamp_ns
        return self.pose

    def _measured(self, travel: float, rng: np.random.Generator) -> float:
        if self._noise == 0:
            return travel
        return travel + self._noise * math.sqrt(abs(travel)) * float(rng.normal())
