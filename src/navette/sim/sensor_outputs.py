# SPDX-License-Identifier: Apache-2.0
"""What each kind of sensor publishes on its topics."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from navette.msgs import topics
from navette.sim import messages, sensor_messages
from navette.sim.ring_lidar import level_scan
from navette.sim.sensor_specs import (
    CameraSensor,
    DepthCameraSensor,
    GnssSensor,
    ImuSensor,
    LidarSensor,
    RingLidarSensor,
    Sensor,
    SonarSensor,
)
from navette.sim.sensor_topics import SensorTopic

MakeMessage = Callable[[Any, Any, int, str], Any]
"""Returns a message from reading, sensor, stamp (ns) and frame."""


class SensorOutput(NamedTuple):
    """How the messages of a topic are made.

    Attributes:
        needs_reading: False: the message needs no measurement, and gets None.
    """

    message: MakeMessage
    needs_reading: bool = True


def _scan_message(reading: Any, sensor: LidarSensor, stamp_ns: int, frame: str) -> Any:
    return messages.scan_message(reading, stamp_ns, frame, 1.0 / sensor.rate_hz)


def _image_message(reading: Any, sensor: Sensor, stamp_ns: int, frame: str) -> Any:
    return messages.image_message(reading, stamp_ns, frame)


def _info_message(_: Any, sensor: CameraSensor, stamp_ns: int, frame: str) -> Any:
    return messages.camera_info_message(sensor, stamp_ns, frame)


def _level_message(
    reading: Any, sensor: RingLidarSensor, stamp_ns: int, frame: str
) -> Any:
    scan = level_scan(reading, sensor)
    return messages.scan_message(scan, stamp_ns, frame, 1.0 / sensor.rate_hz)


_OUTPUTS: Mapping[tuple[type[Sensor], str], SensorOutput] = {
    (LidarSensor, topics.LIDAR.name): SensorOutput(_scan_message),
    (ImuSensor, topics.IMU.name): SensorOutput(messages.imu_message),
    (CameraSensor, topics.CAMERA.name): SensorOutput(_image_message),
    (CameraSensor, topics.CAMERA_INFO.name): SensorOutput(
        _info_message, needs_reading=False
    ),
    (RingLidarSensor, topics.POINTS.name): SensorOutput(
        sensor_messages.ring_points_message
    ),
    (RingLidarSensor, topics.LIDAR.name): SensorOutput(_level_message),
    (DepthCameraSensor, topics.DEPTH_IMAGE.name): SensorOutput(
        sensor_messages.depth_message
    ),
    (DepthCameraSensor, topics.DEPTH_INFO.name): SensorOutput(
        _info_message, needs_reading=False
    ),
    (DepthCameraSensor, topics.DEPTH_POINTS.name): SensorOutput(
        sensor_messages.depth_points_message
    ),
    (SonarSensor, topics.SONAR.name): SensorOutput(sensor_messages.range_message),
    (GnssSensor, topics.FIX.name): SensorOutput(sensor_messages.fix_message),
}


def output_of(topic: SensorTopic) -> SensorOutput:
    """Return how the messages of a sensor's topic are made."""
    return _OUTPUTS[type(topic.sensor), topic.stack.name]
