# SPDX-License-Identifier: Apache-2.0
"""Compiles a scene into a MuJoCo model and remembers which index is what.

Collision masks: ground (1) and obstacles (2) never meet each other; free bodies
(4) and the robot meet them and one another. Geometry groups tell sensors what to
see: 0 seen and solid, 1 only seen, 2 only solid; 3, 4, 5 the same for the robot,
which its own sensors do not see.

Wheels touch the ground through a crowned tyre, an ellipsoid of the wheel's radius
and width: one contact point in the wheel's plane, as a tyre has. A rigid cylinder
rests on both rims, which scrub against each other when the robot turns: it turned
6–12 % slower than commanded, the crowned tyre within 1 %. Against obstacles the
wheel keeps its true shape.

Skid steering slides all four tyres sideways. On stiff contacts that makes MuJoCo's
wheels hop and the robot turns at a fifth of the commanded rate, in jerks; compliant
tyres, as such robots have, slide smoothly. A drive's effective wheel separation
then is 1.6 (Jackal) to 2 (Husky) times the track, as the makers' settings too say.
"""

from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Transform3
from navette.sim.drive_geometry import DriveWheel, base_of, drive_wheels
from navette.sim.scene import (
    Cylinder,
    DiffDrive,
    Ellipsoid,
    Geometry,
    JointKind,
    Link,
    Model,
    Plane,
    Scene,
)
from navette.sim.shape_geoms import add_geom, friction_of

GROUND, OBSTACLE, FREE = 1, 2, 4
SEEN_SOLID, SEEN, SOLID = 0, 1, 2
ROBOT_GROUP = 3  # added to the three above

_SERVO_TIME_S = 0.002  # time constant of the wheel speed servo; longer ones droop
_STIFF_IMPRATIO = 10.0  # friction stiffer than contact: little creep
_STIFF_SOLIMP = (0.9, 0.95, 0.001, 0.5, 2.0)  # MuJoCo's default
_TYRE_IMPRATIO = 1.0
_TYRE_SOLIMP = (0.3, 0.8, 0.01, 0.5, 2.0)  # a tyre that gives by millimetres


@dataclass(frozen=True)
class RobotIndex:
    """Where the robot is in MuJoCo's arrays."""

    model: Model
    drive: DiffDrive
    model_T_base: Transform3
    root_body: int
    root_T_model: Transform3  # root link's frame to the model's
    qpos: int  # of the free joint
    qvel: int
    wheels: tuple[DriveWheel, ...]
    wheel_qpos: NDArray[np.int64]
    wheel_qvel: NDArray[np.int64]
    actuators: NDArray[np.int64]
    bodies: dict[str, int]  # link name → body


@dataclass(frozen=True)
class Compiled:
    """A compiled scene. ``geom_owner``: "model/link" of each geom, by index."""

    model: mujoco.MjModel
    scene: Scene
    robot: RobotIndex
    geom_owner: tuple[str, ...]
    is_robot: NDArray[np.bool_]
    is_ground: NDArray[np.bool_]
    is_obstacle: NDArray[np.bool_]


def compile_scene(scene: Scene, *, timestep_s: float) -> Compiled:
    """MuJoCo model of a scene that has a robot.

    Raises:
        InvalidValueError: no robot in it, or a model that physics cannot take.
    """
    robot = scene.robot
    if robot is None or robot.drive is None:
        raise InvalidValueError(f"world {scene.name!r} has no robot with a drive")
    spec = _empty_spec(scene, timestep_s)
    skid = len(drive_wheels(robot)) > 2
    spec.option.impratio = _TYRE_IMPRATIO if skid else _STIFF_IMPRATIO
    builder = _Builder(spec, scene, _TYRE_SOLIMP if skid else _STIFF_SOLIMP)
    builder.add_ground_if_missing()
    for model in scene.models:
        builder.add_model(model, is_robot=model is robot)
    builder.add_servos(robot, robot.drive)
    try:
        compiled = spec.compile()
    except ValueError as error:
        raise InvalidValueError(f"world {scene.name!r}: {error}") from error
    return _index(compiled, scene, robot, builder)


def _empty_spec(scene: Scene, timestep_s: float) -> mujoco.MjSpec:
    if scene.mjcf is not None:
        spec = mujoco.MjSpec.from_file(str(scene.mjcf))
    else:
        spec = mujoco.MjSpec()
        spec.option.gravity = scene.gravity
    spec.option.timestep = timestep_s
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    return spec


class _Builder:
    def __init__(
        self, spec: mujoco.MjSpec, scene: Scene, tyre_solimp: tuple[float, ...]
    ) -> None:
        self.spec = spec
        self.tyre_solimp = tyre_solimp
        self.scene = scene
        self.owner: dict[str, str] = {}
        self.ground: set[str] = set()
        self.bodies: dict[tuple[str, str], str] = {}
        planes = [
            geometry.friction
            for model in scene.models
            for link in model.links
            for geometry in link.geometries
            if isinstance(geometry.shape, Plane) and geometry.friction is not None
        ]
        # Gazebo takes the smaller friction of a pair, MuJoCo the larger: the
        # wheels get the smaller one and the say (priority).
        self.ground_friction = min(planes, default=1.0)

    def add_ground_if_missing(self) -> None:
        for model in self.scene.models:
            for link in model.links:
                for geometry in link.geometries:
                    if isinstance(geometry.shape, Plane) and geometry.collides:
                        return
        if self.scene.mjcf is None:
            plane = Geometry(name="plane", shape=Plane())
            link = Link(name="link", geometries=(plane,))
            self.add_model(
                Model(name="ground", static=True, links=(link,)), is_robot=False
            )

    def add_model(self, model: Model, *, is_robot: bool) -> None:
        if model.static:
            for link in model.links:
                self._add_static(model, link)
            return
        for link in _roots(model):
            world_T_link = model.world_T_model @ link.model_T_link
            body = self._add_body(
                self.spec.worldbody, model, link, world_T_link, is_robot
            )
            pinned = any(
                j.child == link.name and j.parent == "world" for j in model.joints
            )
            if not pinned:
                body.add_freejoint(name=f"{model.name}/{link.name}/free")

    def _add_static(self, model: Model, link: Link) -> None:
        world_T_link = model.world_T_model @ link.model_T_link
        for geometry in link.geometries:
            ground = isinstance(geometry.shape, Plane)
            name = self._name(model, link, geometry)
            add_geom(
                self.spec.worldbody,
                name,
                geometry,
                world_T_link @ geometry.link_T_shape,
                group=_group(geometry),
                contype=(GROUND if ground else OBSTACLE) if geometry.collides else 0,
                conaffinity=0,
            )
            if ground:
                self.ground.add(name)

    def _name(self, model: Model, link: Link, geometry: Geometry) -> str:
        name = f"{model.name}/{link.name}/{geometry.name}#{len(self.owner)}"
        self.owner[name] = f"{model.name}/{link.name}"
        return name

    def _add_body(
        self,
        parent: mujoco.MjsBody,
        model: Model,
        link: Link,
        pose: Transform3,
        is_robot: bool,
    ) -> mujoco.MjsBody:
        name = f"{model.name}/{link.name}"
        body = parent.add_body(name=name, pos=pose.translation, quat=_wxyz(pose))
        self.bodies[model.name, link.name] = name
        _set_inertia(body, link)
        self._add_geometries(body, model, link, is_robot=is_robot)
        for joint in model.joints:
            if joint.parent != link.name:
                continue
            child = model.link(joint.child)
            link_T_child = link.model_T_link.inverse() @ child.model_T_link
            inner = self._add_body(body, model, child, link_T_child, is_robot)
            _add_joint(inner, model, joint.name, child)
        return body

    def _add_geometries(
        self, body: mujoco.MjsBody, model: Model, link: Link, *, is_robot: bool
    ) -> None:
        wheels = {w.link for w in drive_wheels(model)} if is_robot else set()
        for geometry in link.geometries:
            affinity = GROUND | OBSTACLE | FREE if geometry.collides else 0
            tyre = _tyre(geometry) if link.name in wheels else None
            if tyre is not None:
                affinity = OBSTACLE | FREE
                self._add_tyre(body, model, link, tyre)
            friction = friction_of(geometry.friction)
            add_geom(
                body,
                self._name(model, link, geometry),
                geometry,
                geometry.link_T_shape,
                group=_group(geometry) + (ROBOT_GROUP if is_robot else 0),
                contype=0 if is_robot or not geometry.collides else FREE,
                conaffinity=affinity,
                friction=min(friction, self.ground_friction) if is_robot else None,
                priority=1 if is_robot else 0,
            )

    def _add_tyre(
        self, body: mujoco.MjsBody, model: Model, link: Link, tyre: Geometry
    ) -> None:
        add_geom(
            body,
            self._name(model, link, tyre),
            tyre,
            tyre.link_T_shape,
            group=SOLID + ROBOT_GROUP,
            contype=0,
            conaffinity=GROUND,
            friction=min(friction_of(tyre.friction), self.ground_friction),
            priority=1,
            solimp=self.tyre_solimp,
        )

    def add_servos(self, robot: Model, drive: DiffDrive) -> None:
        """A speed servo on each driven wheel, with a gain that suits its load."""
        mass = sum(link.inertial.mass if link.inertial else 1.0 for link in robot.links)
        wheels = drive_wheels(robot)
        for wheel in wheels:
            own = robot.link(wheel.link).inertial
            spin = max(own.inertia[:3]) if own else 0.0
            load = mass * drive.wheel_radius**2 / len(wheels) + spin
            servo = self.spec.add_actuator(
                name=f"{robot.name}/{wheel.joint}",
                target=f"{robot.name}/{wheel.joint}",
                trntype=mujoco.mjtTrn.mjTRN_JOINT,
            )
            servo.set_to_velocity(kv=load / _SERVO_TIME_S)
            if drive.max_wheel_torque is not None:
                servo.forcelimited = True
                servo.forcerange = [-drive.max_wheel_torque, drive.max_wheel_torque]


def _roots(model: Model) -> list[Link]:
    """Links that no other link carries.

    Raises:
        InvalidValueError: two joints carry one link, or links carry each other.
    """
    carried = [joint.child for joint in model.joints if joint.parent != "world"]
    twice = {name for name in carried if carried.count(name) > 1}
    roots = [link for link in model.links if link.name not in carried]
    reached = {link.name for link in roots}
    while True:
        more = {j.child for j in model.joints if j.parent in reached} - reached
        if not more:
            break
        reached |= more
    lost = {link.name for link in model.links} - reached
    if twice or lost:
        raise InvalidValueError(
            f"model {model.name!r}: joints must form a tree; "
            f"see links {', '.join(sorted(twice | lost))}"
        )
    return roots


def _group(geometry: Geometry) -> int:
    if geometry.collides:
        return SEEN_SOLID if geometry.visible else SOLID
    return SEEN


def _tyre(geometry: Geometry) -> Geometry | None:
    """The crowned tyre of a solid wheel; None when it needs none."""
    shape = geometry.shape
    if not geometry.collides or not isinstance(shape, Cylinder):
        return None
    crown = Ellipsoid((shape.radius, shape.radius, shape.length / 2))
    return replace(geometry, name=f"{geometry.name} tyre", shape=crown, visible=False)


def _wxyz(pose: Transform3) -> tuple[float, float, float, float]:
    x, y, z, w = pose.rotation
    return (w, x, y, z)


def _set_inertia(body: mujoco.MjsBody, link: Link) -> None:
    """Mass and inertia; MuJoCo's own default pose would add the body's position."""
    body.explicitinertial = True
    inertial = link.inertial
    if inertial is None:
        body.mass, body.inertia = 1.0, [0.1, 0.1, 0.1]
        body.ipos, body.iquat = [0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]
        return
    xx, yy, zz, xy, xz, yz = inertial.inertia
    values, axes = np.linalg.eigh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    if not _is_physical(values):
        raise InvalidValueError(
            f"link {link.name!r}: inertia {inertial.inertia} is not that of a body"
        )
    if np.linalg.det(axes) < 0:
        axes[:, 0] = -axes[:, 0]
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, np.ascontiguousarray(axes).ravel())
    whole = np.zeros(4)
    mujoco.mju_mulQuat(whole, np.array(_wxyz(inertial.link_T_com)), turn)
    body.mass, body.inertia = inertial.mass, values
    body.ipos, body.iquat = inertial.link_T_com.translation, whole


def _is_physical(moments: NDArray[np.float64]) -> bool:
    """Principal moments (ascending) are positive and obey the triangle rule."""
    a, b, c = moments
    return bool(a > 0 and a + b >= c * (1 - 1e-6))


def _add_joint(body: mujoco.MjsBody, model: Model, name: str, child: Link) -> None:
    joint = model.joint(name)
    if joint.kind is JointKind.FIXED:
        return
    link_T_joint = child.model_T_link.inverse() @ joint.model_T_joint
    axis = Transform3((0.0, 0.0, 0.0), link_T_joint.rotation).apply(joint.axis)
    types = {
        JointKind.REVOLUTE: mujoco.mjtJoint.mjJNT_HINGE,
        JointKind.PRISMATIC: mujoco.mjtJoint.mjJNT_SLIDE,
        JointKind.BALL: mujoco.mjtJoint.mjJNT_BALL,
    }
    added = body.add_joint(
        name=f"{model.name}/{name}",
        type=types[joint.kind],
        pos=link_T_joint.translation,
        axis=axis,
        frictionloss=joint.friction,
    )
    added.damping = [joint.damping, 0.0, 0.0]  # linear, no higher powers
    if joint.limits is not None and joint.kind is not JointKind.BALL:
        added.limited = True
        added.range = joint.limits


def _index(
    model: mujoco.MjModel, scene: Scene, robot: Model, builder: _Builder
) -> Compiled:
    names = [model.geom(i).name for i in range(model.ngeom)]
    groups = np.array(model.geom_group)
    is_robot = groups >= ROBOT_GROUP
    is_ground = np.array([name in builder.ground for name in names], dtype=np.bool_)
    is_ground |= (np.array(model.geom_type) == mujoco.mjtGeom.mjGEOM_PLANE) & ~is_robot
    solid = (np.array(model.geom_contype) != 0) & ~is_robot
    owners = tuple(
        builder.owner.get(name, name or f"geom {i}") for i, name in enumerate(names)
    )
    return Compiled(
        model=model,
        scene=scene,
        robot=_index_robot(model, robot, builder),
        geom_owner=owners,
        is_robot=is_robot,
        is_ground=is_ground,
        is_obstacle=solid & ~is_ground,
    )


def _index_robot(model: mujoco.MjModel, robot: Model, builder: _Builder) -> RobotIndex:
    assert robot.drive is not None
    root = _roots(robot)[0]
    wheels = drive_wheels(robot)
    free = model.joint(f"{robot.name}/{root.name}/free").id
    joints = [model.joint(f"{robot.name}/{wheel.joint}").id for wheel in wheels]
    servos = [model.actuator(f"{robot.name}/{wheel.joint}").id for wheel in wheels]
    return RobotIndex(
        model=robot,
        drive=robot.drive,
        model_T_base=base_of(robot),
        root_body=model.body(f"{robot.name}/{root.name}").id,
        root_T_model=root.model_T_link.inverse(),
        qpos=int(model.jnt_qposadr[free]),
        qvel=int(model.jnt_dofadr[free]),
        wheels=wheels,
        wheel_qpos=np.array([model.jnt_qposadr[j] for j in joints], dtype=np.int64),
        wheel_qvel=np.array([model.jnt_dofadr[j] for j in joints], dtype=np.int64),
        actuators=np.array(servos, dtype=np.int64),
        bodies={
            link.name: model.body(f"{robot.name}/{link.name}").id
            for link in robot.links
        },
    )
