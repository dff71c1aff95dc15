# SPDX-License-Identifier: Apache-2.0
"""The kinds of sensors: how each is made from its description.

What a kind publishes is in :mod:`navette.sim.sensor_outputs`.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from navette.sim.bodies import camera_name
from navette.sim.build import Compiled
from navette.sim.bumper import Bumper
from navette.sim.camera import Camera
from navette.sim.camera_gl import GlCamera, wants_gl
from navette.sim.depth_camera import DepthCamera
from navette.sim.gnss import GnssReceiver
from navette.sim.imu import Imu, ImuErrors
from navette.sim.instant import Instant
from navette.sim.lidar import Lidar
from navette.sim.mount import Mount
from navette.sim.params import SimParams
from navette.sim.ring_lidar import RingLidar
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
from navette.sim.sensor_topics import sensors_of
from navette.sim.sonar import Sonar

S = TypeVar("S", bound=Sensor)


class Device(Protocol):
    """Measures what one sensor describes."""

    def read(self, instant: Instant, rng: np.random.Generator) -> Any:
        """Return the reading of an instant, with noise from ``rng``."""


def make_devices(
    compiled: Compiled, params: SimParams
) -> Mapping[type[Sensor], tuple[Any, ...]]:
    """Create the devices of the robot's sensors, by kind.

    Raises:
        ParameterError: OpenGL is required but not available.
    """
    return {kind: tuple(make(compiled, params)) for kind, make in _MAKERS.items()}


def lidars_of(compiled: Compiled, params: SimParams) -> Iterator[Lidar]:
    """Create the planar laser scanners."""
    for sensor, mount in _mounted(compiled, LidarSensor):
        yield Lidar(sensor, mount, params, compiled)


def _ring_lidars(compiled: Compiled, params: SimParams) -> Iterator[RingLidar]:
    for sensor, mount in _mounted(compiled, RingLidarSensor):
        yield RingLidar(sensor, mount, params, compiled)


def _imus(compiled: Compiled, params: SimParams) -> Iterator[Imu]:
    """Create the IMUs, with the noise of the parameters if they state one."""
    errors = ImuErrors(params.imu_turn_rate_bias_radps, params.imu_heading_drift_rad)
    acceleration = params.imu_acceleration_noise_mps2
    for sensor, mount in _mounted(compiled, ImuSensor):
        turn_rate = params.turn_rate_stddev_radps(sensor.angular_velocity_stddev)
        sensor = replace(sensor, angular_velocity_stddev=turn_rate)
        if acceleration >= 0.0:
            sensor = replace(sensor, acceleration_stddev=acceleration)
        yield Imu(sensor, mount, errors)


def _cameras(compiled: Compiled, params: SimParams) -> Iterator[Camera | GlCamera]:
    """Create the cameras; raises ParameterError if required OpenGL is not available."""
    robot, model = compiled.robot.model, compiled.model
    cameras = list(sensors_of(robot, CameraSensor))
    use_gl = bool(cameras) and wants_gl(params.camera_renderer)
    for link, sensor in cameras:
        if use_gl:
            yield GlCamera(sensor, camera_name(robot, link, sensor), model)
        else:
            mount = _mount(compiled, link, sensor)
            yield Camera(sensor, mount, compiled.scene, model)


def _depth_cameras(compiled: Compiled, params: SimParams) -> Iterator[DepthCamera]:
    for sensor, mount in _mounted(compiled, DepthCameraSensor):
        yield DepthCamera(sensor, mount, compiled)


def _sonars(compiled: Compiled, params: SimParams) -> Iterator[Sonar]:
    for sensor, mount in _mounted(compiled, SonarSensor):
        yield Sonar(sensor, mount, compiled)


def _bumpers(compiled: Compiled, params: SimParams) -> Iterator[Bumper]:
    for link, sensor in sensors_of(compiled.robot.model, ContactSensor):
        mount = _mount(compiled, link, sensor)
        yield Bumper(sensor, mount, _geoms_of(compiled, link, sensor))


def _receivers(compiled: Compiled, params: SimParams) -> Iterator[GnssReceiver]:
    for sensor, mount in _mounted(compiled, GnssSensor):
        yield GnssReceiver(sensor, mount, compiled.scene.origin)


# In the order of the random streams: new kinds come last.
_MAKERS: Mapping[type[Sensor], Callable[[Compiled, SimParams], Iterator[Device]]] = {
    LidarSensor: lidars_of,
    ImuSensor: _imus,
    CameraSensor: _cameras,
    RingLidarSensor: _ring_lidars,
    DepthCameraSensor: _depth_cameras,
    SonarSensor: _sonars,
    ContactSensor: _bumpers,
    GnssSensor: _receivers,
}


def _mounted(compiled: Compiled, kind: type[S]) -> Iterator[tuple[S, Mount]]:
    for link, sensor in sensors_of(compiled.robot.model, kind):
        yield sensor, _mount(compiled, link, sensor)


def _mount(compiled: Compiled, link: str, sensor: Sensor) -> Mount:
    return Mount(compiled.robot.bodies[link], sensor.link_T_sensor)


def _geoms_of(
    compiled: Compiled, link: str, sensor: ContactSensor
) -> NDArray[np.int64]:
    """Return the geoms of a bumper's collisions."""
    prefix = f"{compiled.robot.model.name}/{link}/"
    names = [compiled.model.geom(i).name for i in range(compiled.model.ngeom)]
    wanted = [
        i
        for i, name in enumerate(names)
        if name.startswith(prefix)
        and (
            not sensor.collisions
            or name.removeprefix(prefix).rpartition("#")[0] in sensor.collisions
        )
    ]
    return np.array(wanted, dtype=np.int64)
