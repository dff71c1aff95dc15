# SPDX-License-Identifier: Apache-2.0
"""A receiver of satellite navigation."""

import math
from dataclasses import dataclass

import numpy as np

from navette.geometry.geodesy import GeoPoint, LocalPlane
from navette.sim.instant import Instant
from navette.sim.mount import Mount
from navette.sim.scene import GeoOrigin
from navette.sim.sensor_specs import GnssSensor


@dataclass(frozen=True)
class Fix:
    """Position of the antenna on the Earth."""

    stamp_ns: int
    point: GeoPoint


class GnssReceiver:
    """Position with white noise; the world's x axis points east by default."""

    def __init__(self, sensor: GnssSensor, mount: Mount, origin: GeoOrigin) -> None:
        self.sensor = sensor
        self.mount = mount
        self._origin = origin
        point = GeoPoint(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)
        self._plane = LocalPlane(point)

    def read(self, instant: Instant, rng: np.random.Generator) -> Fix:
        """Return the measured position."""
        s = self.sensor
        (x, y, z), _ = self.mount.world(instant.data)
        turn = math.radians(self._origin.heading_deg)
        east = math.cos(turn) * x - math.sin(turn) * y
        north = math.sin(turn) * x + math.cos(turn) * y
        errors = rng.standard_normal(3)
        east += s.horizontal_stddev * errors[0]
        north += s.horizontal_stddev * errors[1]
        altitude = float(self._origin.altitude_m + z + s.vertical_stddev * errors[2])
        return Fix(instant.stamp_ns, self._plane.point_at(east, north, altitude))
