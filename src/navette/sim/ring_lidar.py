# SPDX-License-Identifier: Apache-2.0
"""A laser scanner with several rings of beams, by ray casting."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.sim.build import Compiled
from navette.sim.instant import Instant
from navette.sim.lidar import BeamSensor, Scan
from navette.sim.mount import Mount
from navette.sim.params import SimParams
from navette.sim.sensor_specs import RingLidarSensor
from navette.sim.shape_table import ring_directions

_PERCENT = 100.0  # of calibrated reflectivity, as the intensity of diffuse surfaces


@dataclass(frozen=True)
class RingScan:
    """One revolution; ring r, beam i.

    Attributes:
        ranges: (R, N) m, as those of :class:`~navette.sim.lidar.Scan`.
        intensities: (R, N) percent of the light reflected, 0 without an echo.
        points: (R, N, 3) m in the sensor's frame, NaN without an echo.
    """

    stamp_ns: int
    ranges: NDArray[np.float32]
    intensities: NDArray[np.float32]
    points: NDArray[np.float32]


class RingLidar(BeamSensor):
    """Casts the beams of one lidar with several rings."""

    sensor: RingLidarSensor

    def __init__(
        self,
        sensor: RingLidarSensor,
        mount: Mount,
        params: SimParams,
        compiled: Compiled,
    ) -> None:
        super().__init__(sensor, mount, params, compiled)
        s = sensor
        self._azimuths = np.linspace(s.angle_min, s.angle_max, s.samples)
        self._elevations = np.linspace(s.elevation_min, s.elevation_max, s.rings)
        self._directions = ring_directions(self._azimuths, self._elevations)

    def read(self, instant: Instant, rng: np.random.Generator) -> RingScan:
        """Cast all beams."""
        s, shapes = self.sensor, self._shapes
        shapes.update(instant.data)
        pose = self.mount.world(instant.data)
        distance, rows = shapes.cast_rings(
            instant.model,
            instant.data,
            pose,
            self._azimuths,
            self._elevations,
            s.range_max,
        )
        if self._noise_m > 0:
            distance += rng.normal(0.0, self._noise_m, distance.shape)
        ranges = distance.astype(np.float32)
        ranges[ranges < s.range_min] = -np.inf
        if self._dropout > 0:
            ranges[rng.random(ranges.shape) < self._dropout] = np.nan
        seen = np.isfinite(ranges)
        intensities = np.zeros(ranges.shape, np.float32)
        intensities[seen] = _PERCENT * shapes.reflectivity[rows[seen]]
        points = np.full((*ranges.shape, 3), np.nan, np.float32)
        points[seen] = self._directions[seen] * ranges[seen][:, None]
        return RingScan(instant.stamp_ns, ranges, intensities, points)


def level_scan(scan: RingScan, sensor: RingLidarSensor) -> Scan:
    """Return the ring nearest to the horizontal as a planar scan.

    The ranges are those in the plane, as from ``velodyne_laserscan``.
    """
    elevations = np.linspace(sensor.elevation_min, sensor.elevation_max, sensor.rings)
    ring = int(np.argmin(np.abs(elevations)))
    s, n = sensor, sensor.samples
    increment = (s.angle_max - s.angle_min) / (n - 1) if n > 1 else 0.0
    ranges = scan.ranges[ring] * np.float32(np.cos(elevations[ring]))
    return Scan(scan.stamp_ns, s.angle_min, increment, s.range_min, s.range_max, ranges)
