# SPDX-License-Identifier: Apache-2.0
"""What each kind of sensor publishes: topics and messages."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from navette.msgs import topics
from navette.msgs.topics import StackTopic
from navette.sim import messages, sensor_messages
from navette.sim.ring_lidar import level_scan
from navette.sim.scene import Model
from navette.sim.sensor_specs import (
    CameraSensor,
    ContactSensor,
    DepthCameraSensor,
    GnssSensor,
    ImuSensor,
    LidarSensor,
    RingLidarSensor,
    Sensor,
    SonarSensor,
)
from navette.sim.sensors import sensors_of

Message = Callable[[Any, Any, int, str], Any]
"""From reading, sensor, stamp (ns) and frame."""


class SensorOutput(NamedTuple):
    """A topic of a kind of sensor; the kind's first sensor has the plain name.

    Attributes:
        message: makes the message.
        needs_reading: False: the message needs no measurement, and gets None.
    """

    topic: StackTopic
    message: Message
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


SENSOR_OUTPUTS: Mapping[type[Sensor], tuple[SensorOutput, ...]] = {
    LidarSensor: (SensorOutput(topics.LIDAR, _scan_message),),
    ImuSensor: (SensorOutput(topics.IMU, messages.imu_message),),
    CameraSensor: (
        SensorOutput(topics.CAMERA, _image_message),
        SensorOutput(topics.CAMERA_INFO, _info_message, needs_reading=False),
    ),
    RingLidarSensor: (
        SensorOutput(topics.POINTS, sensor_messages.ring_points_message),
    ),
    DepthCameraSensor: (
        SensorOutput(topics.DEPTH_IMAGE, sensor_messages.depth_message),
        SensorOutput(topics.DEPTH_INFO, _info_message, needs_reading=False),
        SensorOutput(topics.DEPTH_POINTS, sensor_messages.depth_points_message),
    ),
    SonarSensor: (SensorOutput(topics.SONAR, sensor_messages.range_message),),
    GnssSensor: (SensorOutput(topics.FIX, sensor_messages.fix_message),),
}
"""All kinds but bumpers, which share one topic: :data:`navette.msgs.topics.HAZARDS`."""


_LEVEL = SensorOutput(topics.LIDAR, _level_message)
"""Of a robot without a planar lidar: navigation needs a scan."""


@dataclass(frozen=True)
class SensorTopic:
    """A topic of one sensor of a robot.

    Attributes:
        index: of the sensor among those of its kind.
        name: of the topic.
    """

    sensor: Sensor
    link: str
    index: int
    name: str
    output: SensorOutput


def topics_of(model: Model) -> Iterator[SensorTopic]:
    """Return the topics of a robot's sensors.

    The first sensor of each kind has the stack's names. A further one has the name of
    its model's ``<topic>``, or that of the stack followed by its own.
    """
    taken: set[str] = set()
    is_planar = any(sensors_of(model, LidarSensor))
    for kind, outputs in SENSOR_OUTPUTS.items():
        if kind is RingLidarSensor and not is_planar:
            outputs = (*outputs, _LEVEL)
        for index, (link, sensor) in enumerate(sensors_of(model, kind)):
            for output in outputs:
                name = output.topic.name
                if index > 0:
                    name = _further(name, outputs, sensor)
                while name in taken:
                    name += "_"
                taken.add(name)
                yield SensorTopic(sensor, link, index, name, output)


def _further(topic: str, outputs: tuple[SensorOutput, ...], sensor: Sensor) -> str:
    plain = "".join(c if c.isalnum() else "_" for c in sensor.name)
    if not sensor.topic:
        return f"{topic}/{plain}"
    own = "/" + sensor.topic.strip("/")
    return own if len(outputs) == 1 else f"{own}/{topic.rpartition('/')[2]}"


def has_bumper(model: Model) -> bool:
    """Whether a robot has a bumper."""
    return any(sensors_of(model, ContactSensor))
