# SPDX-License-Identifier: Apache-2.0
"""Create the sensors of a robot's model."""

from collections.abc import Iterator
from dataclasses import replace
from typing import TypeVar

from navette.sim.bodies import camera_name
from navette.sim.build import Compiled
from navette.sim.camera import Camera
from navette.sim.camera_gl import GlCamera, wants_gl
from navette.sim.imu import Imu, ImuErrors
from navette.sim.lidar import Lidar
from navette.sim.mount import Mount
from navette.sim.params import SimParams
from navette.sim.scene import CameraSensor, ImuSensor, LidarSensor, Model, Sensor

S = TypeVar("S", bound=Sensor)


def sensors_of(model: Model, kind: type[S]) -> Iterator[tuple[str, S]]:
    """Return (link name, sensor) of one kind, in the order of the model."""
    for link in model.links:
        for sensor in link.sensors:
            if isinstance(sensor, kind):
                yield link.name, sensor


def lidars_of(compiled: Compiled, params: SimParams) -> Iterator[Lidar]:
    for link, sensor in sensors_of(compiled.robot.model, LidarSensor):
        yield Lidar(sensor, _mount(compiled, link, sensor), params, compiled.model)


def imus_of(compiled: Compiled, params: SimParams) -> Iterator[Imu]:
    """Create the IMUs, with the noise of the parameters if they state one."""
    errors = ImuErrors(params.imu_turn_rate_bias_radps, params.imu_heading_drift_rad)
    turn_rate, acceleration = (
        params.imu_turn_rate_noise_radps,
        params.imu_acceleration_noise_mps2,
    )
    for link, sensor in sensors_of(compiled.robot.model, ImuSensor):
        if turn_rate >= 0.0:
            sensor = replace(sensor, angular_velocity_stddev=turn_rate)
        if acceleration >= 0.0:
            sensor = replace(sensor, acceleration_stddev=acceleration)
        yield Imu(sensor, _mount(compiled, link, sensor), errors)


def cameras_of(compiled: Compiled, params: SimParams) -> Iterator[Camera | GlCamera]:
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


def _mount(compiled: Compiled, link: str, sensor: Sensor) -> Mount:
    return Mount(compiled.robot.bodies[link], sensor.link_T_sensor)
