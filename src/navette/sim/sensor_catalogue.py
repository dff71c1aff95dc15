# SPDX-License-Identifier: Apache-2.0
"""Sensors by the name of a product, with the figures of its data sheet.

A robot's file and ``--sensor`` mount them. Sources, as published by the makers:

- ``d435``: Intel RealSense D400 series data sheet: field of view 87° × 58°, baseline
  50 mm, up to about 10 m, 6 to 90 images a second. Error of depth: z² · subpixel /
  (f · baseline), with a subpixel accuracy of 0.08 and f = 447 pixels at 848 × 480. The
  image is that of 424 × 240 after the driver's decimation by 2.
- ``vlp16``: Velodyne VLP-16 user manual: 16 rings at ±15°, 0.2° at 10 Hz, 100 m, ±3 cm.
  The driver publishes the echoes as a list.
- ``os1_32``: Ouster OS1-32 data sheet: 32 rings at ±22.5°, 1024 columns at 10 Hz, range
  precision 1 to 3 cm. The driver publishes an organized cloud.
- ``urg04lx``: Hokuyo URG-04LX-UG01: 240° in steps of 0.36°, 0.06 to 4.0 m, 10 Hz,
  accuracy ±30 mm up to 1 m: three standard deviations.
- ``hc_sr04``: ultrasonic module HC-SR04: 2 cm to 4 m, cone of 15°, resolution 3 mm,
  cycles of at least 60 ms.
- ``bumper``: five switches on the front half, as of iRobot Create 3, and one behind.
- ``neo_m8n``: u-blox NEO-M8N: 2.5 m CEP; a CEP is 1.177 standard deviations.
- ``zed_f9p``: u-blox ZED-F9P with RTK: 1 cm CEP.
"""

import math
from dataclasses import dataclass

from navette.sim.sensor_specs import (
    ContactSensor,
    DepthCameraSensor,
    GnssSensor,
    LidarSensor,
    RingLidarSensor,
    Sensor,
    SonarSensor,
)


@dataclass(frozen=True)
class CatalogueSensor:
    """A product, and how it is mounted unless a file gives its pose.

    Attributes:
        place: one of :data:`PLACES`.
        height: share of the robot's height; above 1: on a mast.
        pitch_deg: downward.
    """

    sensor: Sensor
    place: str = "front"
    height: float = 1.0
    pitch_deg: float = 0.0


PLACES = {"front": 0.0, "left": 90.0, "rear": 180.0, "right": -90.0, "top": 0.0}
"""Sides of a robot and the heading (deg) of a sensor there."""

_CEP = 1.1774  # √(2 ln 2): median radius of two normal errors of stddev 1
_D435_NOISE_PER_M = 0.08 / (447 * 0.05)

CATALOGUE: dict[str, CatalogueSensor] = {
    "d435": CatalogueSensor(
        DepthCameraSensor(
            name="d435",
            rate_hz=6.0,
            width=212,
            height=120,
            horizontal_fov=math.radians(87.0),
            near=0.2,
            far=10.0,
            noise_per_m=_D435_NOISE_PER_M,
        ),
        pitch_deg=20.0,
    ),
    "vlp16": CatalogueSensor(
        RingLidarSensor(
            name="vlp16",
            samples=1800,
            angle_min=-math.pi,
            angle_max=math.pi - math.radians(0.2),
            range_min=0.4,
            range_max=100.0,
            noise_stddev=0.03,
            rings=16,
            elevation_min=math.radians(-15.0),
            elevation_max=math.radians(15.0),
            is_organized=False,
        ),
        place="top",
        height=1.25,
    ),
    "os1_32": CatalogueSensor(
        RingLidarSensor(
            name="os1_32",
            samples=1024,
            angle_min=-math.pi,
            angle_max=math.pi - math.tau / 1024,
            range_min=0.5,
            range_max=90.0,
            noise_stddev=0.02,
            rings=32,
            elevation_min=math.radians(-22.5),
            elevation_max=math.radians(22.5),
        ),
        place="top",
        height=1.25,
    ),
    "urg04lx": CatalogueSensor(
        LidarSensor(
            name="urg04lx",
            samples=667,
            angle_min=math.radians(-120.0),
            angle_max=math.radians(120.0),
            range_min=0.06,
            range_max=4.0,
            noise_stddev=0.01,
        ),
        height=0.5,
    ),
    "hc_sr04": CatalogueSensor(
        SonarSensor(
            name="hc_sr04",
            rate_hz=10.0,
            half_angle=math.radians(7.5),
            range_min=0.02,
            range_max=4.0,
            noise_stddev=0.003,
        ),
        height=0.6,
    ),
    "bumper": CatalogueSensor(ContactSensor(name="bump", rate_hz=50.0)),
    "neo_m8n": CatalogueSensor(
        GnssSensor(
            name="neo_m8n",
            rate_hz=5.0,
            horizontal_stddev=2.5 / _CEP,
            vertical_stddev=1.5 * 2.5 / _CEP,
        ),
        place="top",
    ),
    "zed_f9p": CatalogueSensor(
        GnssSensor(
            name="zed_f9p",
            rate_hz=5.0,
            horizontal_stddev=0.01 / _CEP,
            vertical_stddev=0.015,
        ),
        place="top",
    ),
}
"""Products by name."""

# Frames of Create 3's bumper; middle and half width of each sector, deg.
BUMPER_SECTORS = {
    "bump_left": (72.0, 18.0),
    "bump_front_left": (36.0, 18.0),
    "bump_front_center": (0.0, 18.0),
    "bump_front_right": (-36.0, 18.0),
    "bump_right": (-72.0, 18.0),
    "bump_rear": (180.0, 90.0),
}
