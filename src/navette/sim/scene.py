# SPDX-License-Identifier: Apache-2.0
"""A scene of models: plain data that file readers create and the builder compiles.

Poses are :class:`~navette.geometry.Transform3`, named ``outer_T_inner``. Lengths
are metres, angles radians, masses kilograms. All poses inside a model are resolved
to the model's frame, so that the rules of SDF and URDF end at the readers.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path

from navette.errors import InvalidValueError
from navette.geometry import Transform3, Vector3
from navette.sim.sensor_specs import Sensor
from navette.sim.surface import Surface
from navette.sim.trajectory import Trajectory

Colour = tuple[float, float, float, float]  # red, green, blue, alpha in 0…1

_IDENTITY = Transform3.identity()


@dataclass(frozen=True)
class Box:
    size: Vector3  # full edges


@dataclass(frozen=True)
class Cylinder:
    """About its z axis, centred."""

    radius: float
    length: float


@dataclass(frozen=True)
class Capsule:
    """About its z axis, centred; ``length`` is the cylindrical part."""

    radius: float
    length: float


@dataclass(frozen=True)
class Sphere:
    radius: float


@dataclass(frozen=True)
class Ellipsoid:
    radii: Vector3


@dataclass(frozen=True)
class Plane:
    """An infinite plane through the origin; ``size`` is the drawn part."""

    normal: Vector3 = (0.0, 0.0, 1.0)
    size: tuple[float, float] = (100.0, 100.0)


Shape = Box | Cylinder | Capsule | Sphere | Ellipsoid | Plane

_LARGEST_M = 1e5  # beyond it contacts lose millimetre precision


@dataclass(frozen=True, kw_only=True)
class Geometry:
    """A shape on a link: visible to sensors, solid, or both."""

    name: str
    shape: Shape
    link_T_shape: Transform3 = _IDENTITY
    colour: Colour | None = None
    collides: bool = True
    visible: bool = True
    friction: float | None = None
    surface: Surface | None = None  # None: opaque and light, as most
    is_ground: bool = False  # of a static model: floor to drive on, as planes are

    def __post_init__(self) -> None:
        if _largest_measure(self.shape) > _LARGEST_M:
            raise InvalidValueError(
                f"geometry {self.name!r}: {self.shape}: must be at most "
                f"{_LARGEST_M:g} m"
            )


def _largest_measure(shape: Shape) -> float:
    if isinstance(shape, Box):
        return max(shape.size)
    if isinstance(shape, Ellipsoid):
        return max(shape.radii)
    if isinstance(shape, Sphere):
        return shape.radius
    return 0.0 if isinstance(shape, Plane) else max(shape.radius, shape.length)


@dataclass(frozen=True)
class Inertial:
    """Mass (kg) and inertia about the centre of mass (kg m²)."""

    mass: float
    link_T_com: Transform3
    inertia: tuple[float, float, float, float, float, float]  # xx yy zz xy xz yz


@dataclass(frozen=True, kw_only=True)
class Link:
    name: str
    model_T_link: Transform3 = _IDENTITY
    inertial: Inertial | None = None
    geometries: tuple[Geometry, ...] = ()
    sensors: tuple[Sensor, ...] = ()


class JointKind(Enum):
    FIXED = "fixed"
    REVOLUTE = "revolute"  # also continuous: without limits
    PRISMATIC = "prismatic"
    BALL = "ball"


@dataclass(frozen=True, kw_only=True)
class Joint:
    """Connects ``child`` to ``parent`` ("world" pins it); axis in the joint frame."""

    name: str
    kind: JointKind
    parent: str
    child: str
    model_T_joint: Transform3
    axis: Vector3 = (0.0, 0.0, 1.0)
    limits: tuple[float, float] | None = None
    damping: float = 0.0
    friction: float = 0.0


@dataclass(frozen=True)
class SpeedLimits:
    """Limits of a drive in SI units; None where the file has none."""

    speed: float | None = None
    reverse_speed: float | None = None
    yaw_rate: float | None = None
    acceleration: float | None = None
    yaw_acceleration: float | None = None


@dataclass(frozen=True, kw_only=True)
class DiffDrive:
    """Wheels driven in two groups; several per side mean skid steering.

    ``wheel_separation`` converts a yaw rate to wheel speeds: with skid steering it is
    the effective separation, larger than the distance between the wheels.
    """

    left_joints: tuple[str, ...]
    right_joints: tuple[str, ...]
    wheel_separation: float
    wheel_radius: float
    limits: SpeedLimits = SpeedLimits()
    max_wheel_torque: float | None = None


@dataclass(frozen=True, kw_only=True)
class AckermannDrive(DiffDrive):
    """Wheels driven at the rear and steered in front.

    ``wheel_separation`` is the track of the driven wheels, ``kingpin_width`` the
    distance between the axes of the left and the right steering joint.
    """

    left_steering: str
    right_steering: str
    wheel_base: float
    kingpin_width: float
    steering_limit: float

    def curvature_of(self, steering: float) -> float:
        """Return the curvature (1/m) of the base's path at a steering angle (rad)."""
        return math.tan(steering) / self.wheel_base


@dataclass(frozen=True, kw_only=True)
class MecanumDrive(DiffDrive):
    """Four wheels with rollers at 45°, in an X from above; the front ones first.

    ``wheel_separation`` is the sum of track and wheel base: with it the formulas of a
    differential drive give speed and yaw rate.
    """


@dataclass(frozen=True, kw_only=True)
class Model:
    """Links and joints; nested models are flattened already.

    A model with a ``motion`` follows it whatever it touches, and is otherwise static.
    """

    name: str
    world_T_model: Transform3 = _IDENTITY
    static: bool = False
    links: tuple[Link, ...] = ()
    joints: tuple[Joint, ...] = ()
    drive: DiffDrive | None = None
    motion: Trajectory | None = None

    def link(self, name: str) -> Link:
        return next(link for link in self.links if link.name == name)

    def joint(self, name: str) -> Joint:
        for joint in self.joints:
            if joint.name == name:
                return joint
        known = ", ".join(joint.name for joint in self.joints) or "none"
        raise InvalidValueError(
            f"model {self.name!r}: no joint {name!r}; joints: {known}"
        )

    def at(self, world_T_model: Transform3) -> "Model":
        return replace(self, world_T_model=world_T_model)

    @property
    def is_visible(self) -> bool:
        """Whether any shape is visible; True without shapes."""
        shapes = [shape for link in self.links for shape in link.geometries]
        return not shapes or any(shape.visible for shape in shapes)

    def with_shapes(self, change: "ShapeChange") -> "Model":
        """Return a model with every shape changed."""
        links = tuple(
            replace(link, geometries=tuple(map(change, link.geometries)))
            for link in self.links
        )
        return replace(self, links=links)


ShapeChange = Callable[[Geometry], Geometry]
"""Returns the changed shape."""


@dataclass(frozen=True)
class GeoOrigin:
    """Origin of a world on the Earth; its x axis points ``heading_deg`` from east.

    The defaults are those of Gazebo's worlds without ``<spherical_coordinates>``.
    """

    latitude_deg: float = 0.0
    longitude_deg: float = 0.0
    altitude_m: float = 0.0
    heading_deg: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Scene:
    """A world: models, gravity (m/s²) and colours.

    ``start`` is the initial pose of a robot without its own. ``mjcf`` is a MuJoCo model
    file whose contents are added to the scene unchanged. ``origin`` is where the
    world's frame lies on the Earth.
    """

    name: str
    models: tuple[Model, ...] = ()
    gravity: Vector3 = (0.0, 0.0, -9.81)
    sky: Colour = (0.62, 0.76, 0.92, 1.0)
    sun_direction: Vector3 = (-0.5, 0.1, -0.9)
    start: Transform3 = _IDENTITY
    mjcf: Path | None = None
    origin: GeoOrigin = GeoOrigin()

    @property
    def robot(self) -> Model | None:
        """The first model that has a drive."""
        return next((m for m in self.models if m.drive is not None), None)

    def with_robot(self, robot: Model) -> "Scene":
        """Return the scene with ``robot`` in place of its own robot, if it has one.

        The robot is placed at the own robot's pose on the floor, or else at ``start``;
        the model's own pose is added to that.
        """
        own = self.robot
        place = self.start
        if own is not None:
            place = Transform3.from_pose2(own.world_T_model.to_pose2())
        others = tuple(m for m in self.models if m.drive is None)
        return replace(self, models=(*others, robot.at(place @ robot.world_T_model)))
