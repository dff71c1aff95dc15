# SPDX-License-Identifier: Apache-2.0
"""Actuators of the drives: speed servos of wheels, steering, traction of rollers.

A mecanum wheel transmits force to the floor only along the axis of the roller that
touches it. Instead of rollers, which are too small for a stable contact, each wheel has
a tyre without friction and an actuator that pushes the body at the point of contact
along that axis, until the floor moves there as the rim does; the force is limited by
the friction of the wheel's share of the weight.
"""

import math

import mujoco

from navette.geometry import Transform3
from navette.sim.drive_geometry import DriveWheel, base_of, drive_wheels
from navette.sim.scene import AckermannDrive, DiffDrive, Link, MecanumDrive, Model

_SERVO_TIME_S = 0.002  # time constant of the wheel speed servo; a longer one droops
_TRACTION_TIME_S = 0.02
_ROLLER_FRICTION = 0.8
_STEERING_STIFFNESS = 300.0  # 1/s²: angular acceleration per radian of error


def add_servos(spec: mujoco.MjSpec, robot: Model, root: Link) -> None:
    """Add the actuators of the robot's drive; ``root`` is the link of its base."""
    assert robot.drive is not None, "add_servos() of a model without a drive"
    mass = sum(link.inertial.mass if link.inertial else 0.0 for link in robot.links)
    wheels = drive_wheels(robot)
    for wheel in wheels:
        _add_wheel_servo(spec, robot, robot.drive, wheel, mass / len(wheels))
    if isinstance(robot.drive, AckermannDrive):
        for joint in (robot.drive.left_steering, robot.drive.right_steering):
            _add_steering(spec, f"{robot.name}/{joint}", mass, robot.drive)
    if isinstance(robot.drive, MecanumDrive):
        for wheel in wheels:
            _add_traction(spec, robot, root, wheel, mass / len(wheels))


def traction_name(robot: Model, wheel: DriveWheel) -> str:
    """Return MuJoCo's name of the actuator of a mecanum wheel's traction."""
    return f"{robot.name}/{wheel.joint}/traction"


def _add_wheel_servo(
    spec: mujoco.MjSpec, robot: Model, drive: DiffDrive, wheel: DriveWheel, mass: float
) -> None:
    """Add a speed servo with a gain that suits its load."""
    own = robot.link(wheel.link).inertial
    load = mass * drive.wheel_radius**2 + (max(own.inertia[:3]) if own else 0.0)
    name = f"{robot.name}/{wheel.joint}"
    servo = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_JOINT)
    servo.set_to_velocity(kv=load / _SERVO_TIME_S)
    # The rotor inertia of a geared motor is about that of the load.
    # Without it the implicit integrator, stiff servo and light wheel make
    # the wheel slip when it brakes, and the body rocks.
    spec.joint(name).armature = load
    if drive.max_wheel_torque is not None:
        servo.forcelimited = True
        servo.forcerange = [-drive.max_wheel_torque, drive.max_wheel_torque]


def _add_steering(
    spec: mujoco.MjSpec, joint: str, mass: float, drive: AckermannDrive
) -> None:
    """Add a critically damped servo of a steering joint's angle."""
    inertia = 0.25 * mass * drive.wheel_radius**2
    stiffness = _STEERING_STIFFNESS * inertia * 10.0
    servo = spec.add_actuator(
        name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT
    )
    servo.set_to_position(kp=stiffness, kv=2.0 * math.sqrt(stiffness * inertia))
    spec.joint(joint).armature = inertia


def _add_traction(
    spec: mujoco.MjSpec, robot: Model, root: Link, wheel: DriveWheel, mass: float
) -> None:
    root_T_model = root.model_T_link.inverse()
    root_T_base = root_T_model @ base_of(robot)
    hub = root_T_model @ robot.joint(wheel.joint).model_T_joint
    base_T_hub = root_T_base.inverse() @ hub
    x, y, _ = base_T_hub.translation
    touch = root_T_base @ Transform3((x, y, 0.0), (0.0, 0.0, 0.0, 1.0))
    name = traction_name(robot, wheel)
    qx, qy, qz, qw = touch.rotation
    spec.body(f"{robot.name}/{root.name}").add_site(
        name=name, pos=touch.translation, quat=(qw, qx, qy, qz)
    )
    servo = spec.add_actuator(name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_SITE)
    servo.set_to_velocity(kv=mass / _TRACTION_TIME_S / 2)
    # The velocity along the gear is that of the rim when the roller rolls.
    servo.gear = [1.0, -wheel.slide, 0.0, 0.0, 0.0, 0.0]
    most = _ROLLER_FRICTION * mass * 9.81 / math.sqrt(2.0)
    servo.forcelimited = True
    servo.forcerange = [-most, most]
