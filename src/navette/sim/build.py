# SPDX-License-Identifier: Apache-2.0
"""Compile a scene to a MuJoCo model, with the indices of its parts.

Skid steering slides all four tyres sideways. On stiff contacts that makes MuJoCo's
wheels hop, and the robot turns jerkily at a fifth of the commanded rate; compliant
tyres, as on such robots, slide smoothly. The effective wheel separation is then 1.6
(Jackal) to 2 (Husky) times the track, as in the manufacturers' settings.
"""

import logging
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.errors import FileFormatError, InvalidValueError
from navette.geometry import Transform3
from navette.sim.drive_geometry import DriveWheel, base_of, drive_wheels
from navette.sim.masks import ROBOT_GROUP
from navette.sim.model_builder import ModelBuilder, carrier_of
from navette.sim.scene import AckermannDrive, DiffDrive, MecanumDrive, Model, Scene
from navette.sim.servos import add_servos, traction_name
from navette.sim.surface import Surface

# By default MuJoCo writes MUJOCO_LOG.TXT to the working directory.
mujoco.set_mju_user_warning(logging.getLogger(__name__).warning)

_STIFF_IMPRATIO = 10.0  # friction stiffer than contact, for little creep
_STIFF_SOLIMP = (0.9, 0.95, 0.001, 0.5, 2.0)  # MuJoCo's default
_TYRE_IMPRATIO = 1.0
_TYRE_SOLIMP = (0.3, 0.8, 0.01, 0.5, 2.0)  # a tyre that deforms by millimetres


@dataclass(frozen=True)
class RobotIndex:
    """Indices of the robot in MuJoCo's arrays."""

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
    steering: tuple[int, int] | None  # actuators of an Ackermann drive, left first
    traction: NDArray[np.int64]  # actuators of a mecanum drive, one for each wheel
    bodies: dict[str, int]  # link name → body


@dataclass(frozen=True)
class Compiled:
    """A compiled scene.

    ``geom_owner``: "model/link" of each geom, by index; "model" if it has one link.
    """

    model: mujoco.MjModel
    scene: Scene
    robot: RobotIndex
    geom_owner: tuple[str, ...]
    is_robot: NDArray[np.bool_]
    is_ground: NDArray[np.bool_]
    is_obstacle: NDArray[np.bool_]
    surfaces: dict[int, Surface]  # of the geoms that are not plain

    def mocap_of(self, body: str) -> int:
        """Return the index of a body whose pose is set, in MuJoCo's mocap arrays."""
        return int(self.model.body(body).mocapid[0])


def compile_scene(scene: Scene, *, timestep_s: float) -> Compiled:
    """Compile a scene that has a robot.

    Raises:
        InvalidValueError: no robot in the scene, or MuJoCo rejects the model.
    """
    robot = scene.robot
    if robot is None or robot.drive is None:
        raise InvalidValueError(f"world {scene.name!r} has no robot with a drive")
    pinned = any(joint.parent == "world" for joint in robot.joints)
    if robot.static or pinned:
        raise InvalidValueError(f"robot {robot.name!r} is fixed to the world")
    spec = _empty_spec(scene, timestep_s)
    # A drive of this very kind: the wheels of the others are steered or have rollers.
    skid = type(robot.drive) is DiffDrive and len(drive_wheels(robot)) > 2
    spec.option.impratio = _TYRE_IMPRATIO if skid else _STIFF_IMPRATIO
    builder = ModelBuilder(spec, scene, _TYRE_SOLIMP if skid else _STIFF_SOLIMP)
    builder.add_ground_if_missing()
    for model in scene.models:
        builder.add_model(model, is_robot=model is robot)
    add_servos(spec, robot, carrier_of(robot, drive_wheels(robot)[0].link))
    if scene.mjcf is None:
        _let_obstacles_sleep(spec, robot)
    try:
        compiled = spec.compile()
    except ValueError as error:
        raise InvalidValueError(f"world {scene.name!r}: {error}") from error
    return _index(compiled, scene, robot, builder)


def _empty_spec(scene: Scene, timestep_s: float) -> mujoco.MjSpec:
    if scene.mjcf is not None:
        spec = _mjcf_spec(scene.mjcf)
    else:
        spec = mujoco.MjSpec()
        spec.option.gravity = scene.gravity
        _add_sky(spec, scene)
    spec.option.timestep = timestep_s
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    return spec


def _let_obstacles_sleep(spec: mujoco.MjSpec, robot: Model) -> None:
    """Leave obstacles out of the physics while they rest; a touch wakes loose ones.

    The poses of static ones are then computed once, not in each step: a third of the
    time among 6,000 posts. The robot stays awake: its servos hold it, and it would lose
    their small motions.
    """
    spec.option.enableflags |= int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    for body in spec.worldbody.bodies:
        if body.name.startswith(f"{robot.name}/"):
            body.sleep = mujoco.mjtSleepPolicy.mjSLEEP_NEVER


def _mjcf_spec(path: Path) -> mujoco.MjSpec:
    try:
        return mujoco.MjSpec.from_file(str(path))
    except ValueError as error:
        raise FileFormatError(path, str(error)) from error


def _add_sky(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Add sun and sky for OpenGL; ray casting has its own."""
    spec.visual.headlight.ambient = (0.5, 0.5, 0.5)
    spec.worldbody.add_light(
        name="sun",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        dir=scene.sun_direction,
        pos=(0.0, 0.0, 50.0),
        diffuse=(0.6, 0.6, 0.6),
    )
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=scene.sky[:3],
        rgb2=(0.9, 0.93, 0.96),
        width=64,
        height=64,
    )


def _index(
    model: mujoco.MjModel, scene: Scene, robot: Model, builder: ModelBuilder
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
        surfaces={
            i: builder.surfaces[name]
            for i, name in enumerate(names)
            if name in builder.surfaces
        },
    )


def _index_robot(
    model: mujoco.MjModel, robot: Model, builder: ModelBuilder
) -> RobotIndex:
    assert robot.drive is not None
    wheels = drive_wheels(robot)
    root = carrier_of(robot, wheels[0].link)
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
        steering=_steering(model, robot),
        traction=np.array(_traction(model, robot, wheels), dtype=np.int64),
        bodies={
            link.name: model.body(f"{robot.name}/{link.name}").id
            for link in robot.links
        },
    )


def _steering(model: mujoco.MjModel, robot: Model) -> tuple[int, int] | None:
    drive = robot.drive
    if not isinstance(drive, AckermannDrive):
        return None
    left, right = drive.left_steering, drive.right_steering
    return (
        model.actuator(f"{robot.name}/{left}").id,
        model.actuator(f"{robot.name}/{right}").id,
    )


def _traction(
    model: mujoco.MjModel, robot: Model, wheels: tuple[DriveWheel, ...]
) -> list[int]:
    if not isinstance(robot.drive, MecanumDrive):
        return []
    return [model.actuator(traction_name(robot, wheel)).id for wheel in wheels]
