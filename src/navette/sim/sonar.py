# SPDX-License-Identifier: Apache-2.0
"""An ultrasonic range finder by ray casting."""

import math
from dataclasses import dataclass

import numpy as np

from navette.sim.build import Compiled
from navette.sim.instant import Instant
from navette.sim.masks import SEEN, SEEN_SOLID
from navette.sim.mount import Mount
from navette.sim.sensor_specs import SonarSensor
from navette.sim.shape_table import ShapeTable, ring_directions

_RAYS_ACROSS = 31  # the cone of 15° is then sampled every half degree
# Surfaces are smooth for a wave of 8 mm: farther from their normal they reflect it
# away, so that the floor gives no echo (Kuc, Siegel: "Physically based simulation model
# for acoustic sensor robot navigation", PAMI 9, 1987).
_SPECULAR = math.cos(math.radians(45.0))


@dataclass(frozen=True)
class Echo:
    """Range of the first echo, m: +inf without one, −inf closer than the least."""

    stamp_ns: int
    range: float


class Sonar:
    """The nearest surface within a cone; the robot itself is invisible to it.

    Glass and dark surfaces reflect sound as others do; meshes reflect it from every
    side.
    """

    def __init__(self, sensor: SonarSensor, mount: Mount, compiled: Compiled) -> None:
        self.sensor = sensor
        self.mount = mount
        self._shapes = ShapeTable(compiled.model, (SEEN_SOLID, SEEN))
        self._angles = np.linspace(-sensor.half_angle, sensor.half_angle, _RAYS_ACROSS)
        ahead = ring_directions(self._angles, self._angles)[..., 0]
        self._outside = ahead < np.cos(sensor.half_angle) - 1e-9

    def read(self, instant: Instant, rng: np.random.Generator) -> Echo:
        """Measure the range."""
        s, shapes = self.sensor, self._shapes
        shapes.update(instant.data)
        pose = self.mount.world(instant.data)
        cone = instant.model, instant.data, pose, self._angles, self._angles
        first, _ = shapes.cast_rings(*cone, s.range_max)
        distance, _ = shapes.cast_rings(*cone, s.range_max, _SPECULAR)
        # A surface that reflects the sound away hides what is behind it.
        distance[self._outside | (distance > first)] = np.inf
        found = float(distance.min())
        if s.noise_stddev > 0:
            found += float(rng.normal(0.0, s.noise_stddev))
        if found < s.range_min:
            found = -np.inf
        return Echo(instant.stamp_ns, found if found <= s.range_max else np.inf)
