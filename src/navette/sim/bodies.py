# SPDX-License-Identifier: Apache-2.0
"""Inertia, joints, cameras and tyres of one MuJoCo body.

Wheels touch the ground through a crowned tyre, an ellipsoid of the wheel's radius
and width: one contact point in the wheel's plane, as a tyre has. A rigid cylinder
rests on both rims, which scrub when the robot turns: measured yaw rates were 6–12 %
too low with a cylinder and within 1 % with the crowned tyre. For contacts with
obstacles the wheel keeps its true shape.
"""

import math
from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Transform3, quaternion_from_rpy
from navette.sim.scene import (
    Cylinder,
    Ellipsoid,
    Geometry,
    JointKind,
    Link,
    Model,
)
from navette.sim.sensor_specs import CameraSensor

# MuJoCo's cameras look along −z with y up, SDF's along +x with z up.
_SENSOR_T_CAMERA = Transform3(
    (0.0, 0.0, 0.0), quaternion_from_rpy(math.pi / 2, 0.0, -math.pi / 2)
)

_LEAST_MASS, _LEAST_INERTIA = 1e-3, 1e-6


def camera_name(model: Model, link: str, sensor: CameraSensor) -> str:
    """Return MuJoCo's name of a camera, for the OpenGL renderer."""
    return f"{model.name}/{link}/{sensor.name}"


def add_cameras(body: mujoco.MjsBody, model: Model, link: Link) -> None:
    for sensor in link.sensors:
        if isinstance(sensor, CameraSensor):
            half = math.tan(sensor.horizontal_fov / 2) * sensor.height / sensor.width
            body.add_camera(
                name=camera_name(model, link.name, sensor),
                pos=sensor.link_T_sensor.translation,
                quat=wxyz(sensor.link_T_sensor @ _SENSOR_T_CAMERA),
                fovy=math.degrees(2 * math.atan(half)),
            )


def tyre_of(geometry: Geometry) -> Geometry | None:
    """Return the crowned tyre of a solid wheel; None if it needs none."""
    shape = geometry.shape
    if not geometry.collides or not isinstance(shape, Cylinder):
        return None
    crown = Ellipsoid((shape.radius, shape.radius, shape.length / 2))
    return replace(geometry, name=f"{geometry.name} tyre", shape=crown, visible=False)


def wxyz(pose: Transform3) -> tuple[float, float, float, float]:
    x, y, z, w = pose.rotation
    return (w, x, y, z)


def set_inertia(body: mujoco.MjsBody, link: Link, *, moves: bool) -> None:
    """Set mass and inertia; MuJoCo's own default pose would add the body's position.

    A link without inertial is massless, except for one with its own degree of freedom.
    """
    body.explicitinertial = True
    inertial = link.inertial
    if inertial is None:
        body.mass = _LEAST_MASS if moves else 0.0
        body.inertia = [_LEAST_INERTIA if moves else 0.0] * 3
        body.ipos, body.iquat = [0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]
        return
    xx, yy, zz, xy, xz, yz = inertial.inertia
    values, axes = np.linalg.eigh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    if not _is_physical(values):
        raise InvalidValueError(
            f"link {link.name!r}: inertia {inertial.inertia} is not physically possible"
        )
    if np.linalg.det(axes) < 0:
        axes[:, 0] = -axes[:, 0]
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, np.ascontiguousarray(axes).ravel())
    whole = np.zeros(4)
    mujoco.mju_mulQuat(whole, np.array(wxyz(inertial.link_T_com)), turn)
    body.mass, body.inertia = inertial.mass, values
    body.ipos, body.iquat = inertial.link_T_com.translation, whole


def _is_physical(moments: NDArray[np.float64]) -> bool:
    """Whether the principal moments (ascending) are positive and satisfy the triangle
    inequality."""
    a, b, c = moments
    return bool(a > 0 and a + b >= c * (1 - 1e-6))


def add_joint(
    body: mujoco.MjsBody, model: Model, name: str, child: Link, *, degrees: bool
) -> None:
    """Add a joint; ``degrees``: the unit of angles in the specification."""
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
        in_degrees = degrees and joint.kind is JointKind.REVOLUTE
        added.range = np.degrees(joint.limits) if in_degrees else joint.limits
