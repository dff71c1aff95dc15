# SPDX-License-Identifier: Apache-2.0
"""A planar laser scanner by ray casting."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim.build import SEEN, SEEN_SOLID, SOLID
from navette.sim.mount import Mount
from navette.sim.params import SimParams
from navette.sim.scene import LidarSensor


@dataclass(frozen=True)
class Scan:
    """One turn of beams: ``ranges`` (N,) metres, beam i at min + i · increment.

    +inf: nothing within range_max; −inf: closer than range_min; NaN: a beam lost
    (REP 117).
    """

    stamp_ns: int
    angle_min: float
    angle_increment: float
    range_min: float
    range_max: float
    ranges: NDArray[np.float32]


class Lidar:
    """Casts the beams of one sensor; never sees the robot that carries it."""

    def __init__(self, sensor: LidarSensor, mount: Mount, params: SimParams) -> None:
        self.sensor = sensor
        self.mount = mount
        self.set_noise(params)
        n = sensor.samples
        angles = np.linspace(sensor.angle_min, sensor.angle_max, n)
        self.angle_increment = float(angles[1] - angles[0]) if n > 1 else 0.0
        self._beams_sensor = np.stack(
            [np.cos(angles), np.sin(angles), np.zeros(n)], axis=1
        )
        self._groups = np.zeros(mujoco.mjNGROUP, dtype=np.uint8)
        self._groups[[SEEN_SOLID, SEEN if sensor.sees_visuals else SOLID]] = 1
        self._geom = np.empty(n, dtype=np.int32)
        self._distance = np.empty(n)

    def set_noise(self, params: SimParams) -> None:
        """Noise and lost beams from now on; below 0 the sensor's own noise."""
        own = params.lidar_noise_m < 0
        self._noise_m = self.sensor.noise_stddev if own else params.lidar_noise_m
        self._dropout = params.lidar_dropout

    def scan(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        stamp_ns: int,
        rng: np.random.Generator,
    ) -> Scan:
        """Cast all beams in the present state (kinematics must be fresh)."""
        s = self.sensor
        position, rotation = self.mount.world(data)
        beams_world = self._beams_sensor @ rotation.T
        distance = self._distance
        mujoco.mj_multiRay(
            model,
            data,
            position,
            beams_world.ravel(),
            self._groups,
            True,  # static geoms too
            -1,
            self._geom,
            distance,
            None,
            s.samples,
            s.range_max,
        )
        hit = (distance >= 0) & (distance <= s.range_max)
        if self._noise_m > 0:
            distance = distance + rng.normal(0.0, self._noise_m, s.samples)
        ranges = np.where(hit, distance, np.inf).astype(np.float32)
        ranges[ranges < s.range_min] = -np.inf
        if self._dropout > 0:
            ranges[rng.random(s.samples) < self._dropout] = np.nan
        return Scan(
            stamp_ns,
            s.angle_min,
            self.angle_increment,
            s.range_min,
            s.range_max,
            ranges,
        )
