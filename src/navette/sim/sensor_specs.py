# SPDX-License-Identifier: Apache-2.0
"""The sensors of a robot as data: what file readers create and the simulator measures.

Frames are those of SDF: a sensor looks along its +x, with z up.
"""

import math
from dataclasses import dataclass

from navette.geometry import Transform3

_IDENTITY = Transform3.identity()


@dataclass(frozen=True, kw_only=True)
class Sensor:
    """A sensor of a link.

    Attributes:
        frame: frame id of its messages; "" derives it from link and sensor.
        topic: name in the model's file, used where a robot has several of a kind.
    """

    name: str
    link_T_sensor: Transform3 = _IDENTITY
    rate_hz: float = 10.0
    frame: str = ""
    topic: str = ""


@dataclass(frozen=True, kw_only=True)
class LidarSensor(Sensor):
    """A planar laser scanner; the first and last beam lie on the given angles."""

    samples: int = 360
    angle_min: float = -3.141592653589793
    angle_max: float = 3.141592653589793
    range_min: float = 0.1
    range_max: float = 20.0
    noise_stddev: float = 0.0
    sees_visuals: bool = True  # a gpu_lidar sees visuals, a ray sensor collisions


@dataclass(frozen=True, kw_only=True)
class RingLidarSensor(LidarSensor):
    """A laser scanner with several rings of beams, evenly spaced in elevation.

    Attributes:
        rings: number of rings, the lowest first.
        elevation_min, elevation_max: of the first and the last ring, rad.
        is_organized: whether the cloud is a grid (rings, samples) with NaN where
            nothing was hit, as from Ouster's driver; otherwise a list of the hits, as
            from Velodyne's.
    """

    rings: int = 16
    elevation_min: float = -0.2617993877991494
    elevation_max: float = 0.2617993877991494
    is_organized: bool = True


@dataclass(frozen=True, kw_only=True)
class CameraSensor(Sensor):
    """A pinhole camera that looks along its frame's +x, with z up (SDF)."""

    width: int = 320
    height: int = 240
    horizontal_fov: float = 1.047
    near: float = 0.1
    far: float = 100.0


@dataclass(frozen=True, kw_only=True)
class DepthCameraSensor(CameraSensor):
    """A pinhole camera that measures depth along its optical axis.

    The noise of depth z is σ(z) = noise_stddev + noise_per_m · z². Stereo measures a
    disparity d = f b / z, so that an error of the disparity grows with z²: noise_per_m
    = σ_d / (f b), with σ_d and f in pixels and the baseline b in metres.
    """

    noise_stddev: float = 0.0
    noise_per_m: float = 0.0


@dataclass(frozen=True, kw_only=True)
class ImuSensor(Sensor):
    acceleration_stddev: float = 0.0
    angular_velocity_stddev: float = 0.0


@dataclass(frozen=True, kw_only=True)
class SonarSensor(Sensor):
    """The distance to the nearest surface within a cone about the +x axis."""

    half_angle: float = 0.13
    range_min: float = 0.02
    range_max: float = 4.0
    noise_stddev: float = 0.0


@dataclass(frozen=True, kw_only=True)
class ContactSensor(Sensor):
    """A bumper on named collisions of its link; without names, on all of them.

    Attributes:
        collisions: names of geometries of the link.
        bearings: only contacts between these angles close its switch; rad,
            counter-clockwise from the link's +x.
        centre: x, y of the point from which they are measured, link frame, m.
    """

    collisions: tuple[str, ...] = ()
    centre: tuple[float, float] = (0.0, 0.0)
    bearings: tuple[float, float] = (-math.pi, math.pi)


@dataclass(frozen=True, kw_only=True)
class GnssSensor(Sensor):
    """A satellite receiver; standard deviations in metres."""

    horizontal_stddev: float = 0.0
    vertical_stddev: float = 0.0
