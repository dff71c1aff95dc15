# SPDX-License-Identifier: Apache-2.0
"""The topics of a robot's sensors."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from navette.msgs import topics
from navette.msgs.topics import StackTopic
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

S = TypeVar("S", bound=Sensor)

SENSOR_TOPICS: Mapping[type[Sensor], tuple[StackTopic, ...]] = {
    LidarSensor: (topics.LIDAR,),
    ImuSensor: (topics.IMU,),
    CameraSensor: (topics.CAMERA, topics.CAMERA_INFO),
    RingLidarSensor: (topics.POINTS,),
    DepthCameraSensor: (topics.DEPTH_IMAGE, topics.DEPTH_INFO, topics.DEPTH_POINTS),
    SonarSensor: (topics.SONAR,),
    GnssSensor: (topics.FIX,),
}
"""All kinds but bumpers, which share one topic: :data:`navette.msgs.topics.HAZARDS`."""


@dataclass(frozen=True)
class SensorTopic:
    """A topic of one sensor of a robot.

    Attributes:
        index: of the sensor among those of its kind.
        stack: the topic of the kind's first sensor.
        name: of the topic.
    """

    sensor: Sensor
    link: str
    index: int
    stack: StackTopic
    name: str


def sensors_of(model: Model, kind: type[S]) -> Iterator[tuple[str, S]]:
    """Return (link name, sensor) of exactly one kind, in the order of the model."""
    for link in model.links:
        for sensor in link.sensors:
            if type(sensor) is kind:
                yield link.name, sensor


def topics_of(model: Model) -> Iterator[SensorTopic]:
    """Return the topics of a robot's sensors.

    The first sensor of each kind has the stack's names. A further one has the name of
    its model's ``<topic>``, or that of the stack followed by its own. Without a planar
    lidar, the level ring of another one is published as its scan: navigation needs one.
    """
    taken: set[str] = set()
    is_planar = any(sensors_of(model, LidarSensor))
    for kind, published in SENSOR_TOPICS.items():
        for index, (link, sensor) in enumerate(sensors_of(model, kind)):
            levels = kind is RingLidarSensor and not is_planar and index == 0
            for stack in (*published, topics.LIDAR) if levels else published:
                name = stack.name
                if index > 0:
                    name = _further(name, sensor, is_alone=len(published) == 1)
                while name in taken:
                    name += "_"
                taken.add(name)
                yield SensorTopic(sensor, link, index, stack, name)


def _further(topic: str, sensor: Sensor, *, is_alone: bool) -> str:
    plain = "".join(c if c.isalnum() else "_" for c in sensor.name)
    if not sensor.topic:
        return f"{topic}/{plain}"
    own = "/" + sensor.topic.strip("/")
    return own if is_alone else f"{own}/{topic.rpartition('/')[2]}"


def has_bumper(model: Model) -> bool:
    """Whether a robot has a bumper."""
    return any(sensors_of(model, ContactSensor))
