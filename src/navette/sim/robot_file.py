# SPDX-License-Identifier: Apache-2.0
"""Robots described by sizes in a YAML file: a body on two wheels and casters."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError, ParameterError
from navette.files.untrusted.budget import DOCUMENT
from navette.files.untrusted.files import read_bounded
from navette.files.untrusted.yaml_input import load_yaml
from navette.geometry import Transform3
from navette.params import Params, param
from navette.sim.mounting import SensorMount, mounts_of
from navette.sim.scene import (
    Box,
    Cylinder,
    DiffDrive,
    Geometry,
    Inertial,
    Joint,
    JointKind,
    Link,
    Model,
    Shape,
    SpeedLimits,
    Sphere,
)
from navette.sim.sensor_specs import LidarSensor

_LEVEL = (0.0, 0.0, 0.0, 1.0)
_QUARTER = (-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))  # the wheel's axis is y
_WHEEL_MASS_SHARE = 0.05  # of the robot's mass, each
_GROUND_GAP_SHARE = 0.4  # of the wheel's radius, under the body


@dataclass(frozen=True, kw_only=True)
class RobotSizes(Params):
    """Sizes of a robot with two driven wheels and casters; the middle is the axle's."""

    name: str = param("robot", "name of the robot")
    length_m: float = param(0.5, "length of the body", above=0.0)
    width_m: float = param(0.4, "width of the body", above=0.0)
    height_m: float = param(0.2, "height of the body", above=0.0)
    is_round: bool = param(False, "a cylinder of diameter length_m instead of a box")
    mass_kg: float = param(15.0, "mass of the robot", above=0.0)
    axle_x_m: float = param(0.0, "position of the axle, forward of the body's middle")
    wheel_radius_m: float = param(0.08, "radius of the wheels", above=0.0)
    wheel_separation_m: float = param(
        0.0, "distance between the wheels; 0: beside the body", at_least=0.0
    )
    lidar_x_m: float = param(0.0, "lidar, forward of the body's middle")
    lidar_height_m: float = param(
        0.0, "lidar above the floor; 0: on top of the body", at_least=0.0
    )
    lidar_beams: int = param(360, "beams of a scan", at_least=2, at_most=20_000)
    lidar_fov_deg: float = param(360.0, "angle of a scan", above=0.0, at_most=360.0)
    lidar_range_m: float = param(12.0, "largest range", above=0.1)
    lidar_rate_hz: float = param(10.0, "scans per second", at_least=1.0, at_most=100.0)
    lidar_noise_m: float = param(0.0, "standard deviation of the ranges", at_least=0.0)
    max_speed_mps: float = param(1.0, "fastest forward", above=0.0)
    max_reverse_speed_mps: float = param(0.5, "fastest backward", above=0.0)
    max_turn_rate_radps: float = param(2.0, "fastest turn", above=0.0)
    acceleration_mps2: float = param(1.0, "acceleration", above=0.0)
    turn_acceleration_radps2: float = param(4.0, "acceleration of a turn", above=0.0)

    def check(self) -> None:
        if abs(self.axle_x_m) > self.length_m / 2:
            raise ParameterError(
                f"parameter 'axle_x_m': {self.axle_x_m:g}; must be within ±length_m / 2"
            )


@dataclass(frozen=True)
class RobotFile:
    """Content of a robot's YAML file.

    Attributes:
        sizes: of the robot; None: ``model`` describes it.
        model: its SDF or URDF file.
        parameters: node → parameter → value.
        sensors: further ones, by name.
    """

    sizes: RobotSizes | None
    model: Path | None
    parameters: dict[str, dict[str, Any]]
    sensors: dict[str, SensorMount]


def read_robot_file(path: Path) -> RobotFile:
    """Read a YAML file: sizes or ``model: FILE``, and ``parameters`` of the nodes.

    Raises:
        FileFormatError: not such a file; names the key, its value and what is allowed.
    """
    try:
        content = load_yaml(read_bounded(path, DOCUMENT))
    except yaml.YAMLError as error:
        raise FileFormatError(path, f"not YAML: {error}") from None
    if not isinstance(content, dict):
        raise FileFormatError(path, "expected lines 'length_m: 0.5'")
    sensors = content.pop("sensors", {})
    if not isinstance(sensors, dict):
        raise FileFormatError(path, "sensors: expected NAME: TYPE, or NAME: {TYPE: …}")
    try:
        mounts = mounts_of(sensors)
    except ParameterError as error:
        raise FileFormatError(path, str(error)) from None
    parameters = content.pop("parameters", {})
    if not isinstance(parameters, dict) or not all(
        isinstance(values, dict) for values in parameters.values()
    ):
        raise FileFormatError(path, "parameters: expected NODE: {NAME: VALUE}")
    model = content.pop("model", None)
    if model is not None:
        if content:
            raise FileFormatError(
                path, f"beside model: {', '.join(map(str, content))}; sizes are in it"
            )
        return RobotFile(None, path.parent / str(model), parameters, mounts)
    content.setdefault("name", path.stem)
    try:
        sizes = RobotSizes.from_dict(content)
    except ParameterError as error:
        raise FileFormatError(path, str(error)) from None
    return RobotFile(sizes, None, parameters, mounts)


def model_of(sizes: RobotSizes) -> Model:
    """Return the robot's model: body, two wheels, casters in front and behind."""
    radius = sizes.wheel_radius_m
    gap = _GROUND_GAP_SHARE * radius
    wheel_width = 0.4 * radius
    beside = sizes.width_m + 1.2 * wheel_width
    separation = sizes.wheel_separation_m or beside
    wheel_mass = _WHEEL_MASS_SHARE * sizes.mass_kg
    links = [_body(sizes, gap, sizes.mass_kg - 2 * wheel_mass)]
    joints = []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        pose = Transform3((sizes.axle_x_m, sign * separation / 2, radius), _QUARTER)
        wheel = Cylinder(radius, wheel_width)
        link = Link(
            name=f"{side}_wheel",
            model_T_link=pose,
            inertial=_inertial(wheel, wheel_mass, Transform3.identity()),
            geometries=(Geometry(name="tyre", shape=wheel, colour=(0.1, 0.1, 0.1, 1)),),
        )
        links.append(link)
        joints.append(
            Joint(
                name=f"{side}_joint",
                kind=JointKind.REVOLUTE,
                parent="body",
                child=link.name,
                model_T_joint=Transform3(pose.translation, _LEVEL),
                axis=(0.0, 1.0, 0.0),
            )
        )
    return Model(
        name=sizes.name,
        links=tuple(links),
        joints=tuple(joints),
        drive=DiffDrive(
            left_joints=("left_joint",),
            right_joints=("right_joint",),
            wheel_separation=separation,
            wheel_radius=radius,
            limits=SpeedLimits(
                sizes.max_speed_mps,
                sizes.max_reverse_speed_mps,
                sizes.max_turn_rate_radps,
                sizes.acceleration_mps2,
                sizes.turn_acceleration_radps2,
            ),
        ),
    )


def _body(sizes: RobotSizes, gap: float, mass: float) -> Link:
    """Return the body with its casters, spheres without friction, and the lidar."""
    length, width, height = sizes.length_m, sizes.width_m, sizes.height_m
    shape: Shape = Box((length, width, height))
    if sizes.is_round:
        shape = Cylinder(length / 2, height)
    model_T_body = Transform3((0.0, 0.0, gap + height / 2), _LEVEL)
    geometries = [
        Geometry(
            name="body",
            shape=shape,
            link_T_shape=model_T_body,
            colour=(0.20, 0.45, 0.60, 1.0),
        )
    ]
    ball = 0.5 * gap
    for name, x in (("front", length / 2 - 2 * ball), ("rear", 2 * ball - length / 2)):
        if abs(x - sizes.axle_x_m) > length / 4:
            at = Transform3((x, 0.0, ball), _LEVEL)
            geometries.append(
                Geometry(
                    name=f"{name}_caster",
                    shape=Sphere(ball),
                    link_T_shape=at,
                    friction=0.01,
                )
            )
    above = sizes.lidar_height_m or gap + height + 0.05
    half = math.radians(sizes.lidar_fov_deg) / 2
    full = sizes.lidar_fov_deg == 360.0
    last = half - 2 * half / sizes.lidar_beams if full else half
    lidar = LidarSensor(
        name="lidar",
        link_T_sensor=Transform3((sizes.lidar_x_m, 0.0, above), _LEVEL),
        rate_hz=sizes.lidar_rate_hz,
        samples=sizes.lidar_beams,
        angle_min=-half,
        angle_max=last,
        range_min=0.05,
        range_max=sizes.lidar_range_m,
        noise_stddev=sizes.lidar_noise_m,
    )
    return Link(
        name="body",
        # Low, as batteries are: the robot does not tip over when it brakes.
        inertial=_inertial(
            shape, mass, Transform3((0.0, 0.0, gap + height / 4), _LEVEL)
        ),
        geometries=tuple(geometries),
        sensors=(lidar,),
    )


def _inertial(shape: Shape, mass: float, link_T_com: Transform3) -> Inertial:
    """Return the inertia of a solid box, or of a cylinder along z."""
    if isinstance(shape, Box):
        x, y, z = (edge * edge for edge in shape.size)
        moments = (y + z) * mass / 12, (x + z) * mass / 12, (x + y) * mass / 12
    else:
        assert isinstance(shape, Cylinder), "a body is a box or a cylinder"
        across = mass * (3 * shape.radius**2 + shape.length**2) / 12
        moments = across, across, mass * shape.radius**2 / 2
    return Inertial(mass, link_T_com, (*moments, 0.0, 0.0, 0.0))
