# SPDX-License-Identifier: Apache-2.0
"""A planar laser scanner by ray casting."""

import math
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.sim.build import Compiled
from navette.sim.instant import Instant
from navette.sim.masks import SEEN, SEEN_SOLID, SOLID
from navette.sim.mount import Mount
from navette.sim.params import SimParams
from navette.sim.ray_kernels import cast_fan, readings
from navette.sim.sensor_specs import LidarSensor, RingLidarSensor
from navette.sim.shape_table import ShapeTable

_LEVEL = np.zeros(1)  # elevation of the beams


class Scan(NamedTuple):
    """One scan: ``ranges`` (N,) in metres, beam i at angle_min + i · increment.

    +inf: nothing within range_max; −inf: closer than range_min; NaN: lost beam
    (REP 117).
    """

    stamp_ns: int
    angle_min: float
    angle_increment: float
    range_min: float
    range_max: float
    ranges: NDArray[np.float32]


class BeamSensor:
    """Mount, noise and visible shapes of a scanner; the robot is invisible to it."""

    sensor: LidarSensor | RingLidarSensor

    def __init__(
        self,
        sensor: LidarSensor | RingLidarSensor,
        mount: Mount,
        params: SimParams,
        compiled: Compiled,
    ) -> None:
        self.sensor = sensor
        self.mount = mount
        self.set_noise(params)
        groups = (SEEN_SOLID, SEEN if sensor.sees_visuals else SOLID)
        self._shapes = ShapeTable(compiled.model, groups, compiled.surfaces)

    def set_noise(self, params: SimParams) -> None:
        """Set noise and share of lost beams; below 0 means the sensor's own noise."""
        own = params.lidar_noise_m < 0
        stddev = self.sensor.noise_stddev if own else params.lidar_noise_m
        self._noise_m = float(stddev)
        self._dropout = params.lidar_dropout


class Lidar(BeamSensor):
    """Casts the beams of one planar lidar."""

    sensor: LidarSensor

    def __init__(
        self,
        sensor: LidarSensor,
        mount: Mount,
        params: SimParams,
        compiled: Compiled,
    ) -> None:
        super().__init__(sensor, mount, params, compiled)
        n = sensor.samples
        self._angles = np.linspace(sensor.angle_min, sensor.angle_max, n)
        self.angle_increment = (
            float(self._angles[1] - self._angles[0]) if n > 1 else 0.0
        )
        beams = [(math.cos(a), math.sin(a)) for a in self._angles]
        self._beams = np.array(beams).T.copy()
        self._distance, self._noise = np.empty(n), np.zeros(n)

    def warm_up(self) -> None:
        """Compile the kernels, which takes seconds on the very first run."""
        empty = np.zeros((0, 3))
        cast_fan(
            np.zeros(0, dtype=np.int64), empty, empty, np.zeros((0, 3, 3)),
            np.zeros(3), np.eye(3), self._angles, self._beams, 1.0, self._distance,
        )  # fmt: skip
        readings(
            self._distance, self._noise, 0.0, self.sensor.range_min,
            self.sensor.range_max, np.empty(len(self._angles), np.float32),
        )  # fmt: skip

    def read(self, instant: Instant, rng: np.random.Generator) -> Scan:
        """Cast all beams."""
        s, stamp_ns = self.sensor, instant.stamp_ns
        distance = self._cast(instant.model, instant.data)
        is_lost = self._draw(rng)
        ranges = np.empty(s.samples, np.float32)
        readings(distance, self._noise, self._noise_m, s.range_min, s.range_max, ranges)
        if is_lost is not None:
            ranges[is_lost] = np.nan
        return Scan(
            stamp_ns,
            s.angle_min,
            self.angle_increment,
            s.range_min,
            s.range_max,
            ranges,
        )

    def skip(self, rng: np.random.Generator) -> None:
        """Draw the noise of a scan without readers: that of later ones is the same."""
        self._draw(rng)

    def _draw(self, rng: np.random.Generator) -> NDArray[np.bool_] | None:
        """Draw the noise of a scan; return which beams are lost, if any can be."""
        if self._noise_m > 0:
            rng.standard_normal(out=self._noise)
        if self._dropout > 0:
            return rng.random(self.sensor.samples) < self._dropout
        return None

    def _cast(self, model: mujoco.MjModel, data: mujoco.MjData) -> NDArray[np.float64]:
        """True distances (N,) m, inf where nothing is hit."""
        shapes = self._shapes
        shapes.update(data)
        origin, world_R_sensor = self.mount.world(data)
        reach = self.sensor.range_max
        if shapes.has_surfaces:
            pose = origin, world_R_sensor
            rings = shapes.cast_rings(model, data, pose, self._angles, _LEVEL, reach)
            self._distance[:] = rings[0]
            return self._distance
        if shapes.has_others:
            beams = np.stack(
                [np.cos(self._angles), np.sin(self._angles), 0 * self._angles], axis=1
            )
            beams_world = beams @ world_R_sensor.T
            found = shapes.cast_with_mujoco(model, data, origin, beams_world, reach)
            self._distance[:] = found[0]
            return self._distance
        cast_fan(
            shapes.kind, shapes.size, shapes.position, shapes.rotation, origin,
            world_R_sensor, self._angles, self._beams, reach, self._distance,
        )  # fmt: skip
        return self._distance
