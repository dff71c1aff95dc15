# SPDX-License-Identifier: Apache-2.0
"""Convert a geometry of the scene to a MuJoCo geom."""

import math

import mujoco

from navette.geometry import Quaternion, Transform3, Vector3
from navette.sim.scene import (
    Box,
    Capsule,
    Colour,
    Cylinder,
    Ellipsoid,
    Geometry,
    Plane,
    Shape,
    Sphere,
)

_DEFAULT_COLOUR: Colour = (0.7, 0.7, 0.72, 1.0)
_DEFAULT_FRICTION = 1.0
_MAX_FRICTION = 2.0  # files use 100 for "never slips", which only stiffens the solver


def friction_of(value: float | None) -> float:
    """Return the sliding friction coefficient for a file's value."""
    return _DEFAULT_FRICTION if value is None else min(value, _MAX_FRICTION)


def add_geom(
    body: mujoco.MjsBody,
    name: str,
    geometry: Geometry,
    body_T_shape: Transform3,
    *,
    group: int,
    contype: int,
    conaffinity: int,
    friction: float | None = None,
    priority: int = 0,
    solimp: tuple[float, ...] | None = None,
) -> None:
    """Add one geom to a body; ``friction`` overrides the geometry's own."""
    kind, size = _size(geometry.shape)
    rotation = body_T_shape.rotation
    if isinstance(geometry.shape, Plane):
        pose = body_T_shape @ Transform3((0, 0, 0), _tilt(geometry.shape.normal))
        rotation = pose.rotation
    x, y, z, w = rotation
    r, g, b, a = geometry.colour or _DEFAULT_COLOUR
    sliding = friction_of(geometry.friction) if friction is None else friction
    geom = body.add_geom(
        name=name,
        type=kind,
        size=size,
        pos=body_T_shape.translation,
        quat=(w, x, y, z),
        # MuJoCo's rays pass through fully transparent geoms.
        rgba=(r, g, b, max(a, 0.05)),
        group=group,
        contype=contype,
        conaffinity=conaffinity,
        condim=3,
        friction=(sliding, 0.005, 0.0001),
        priority=priority,
    )
    if solimp is not None:
        geom.solimp = solimp


def _size(shape: Shape) -> tuple[mujoco.mjtGeom, list[float]]:
    """MuJoCo's type and half sizes."""
    kinds = mujoco.mjtGeom
    if isinstance(shape, Box):
        return kinds.mjGEOM_BOX, [edge / 2 for edge in shape.size]
    if isinstance(shape, Cylinder):
        return kinds.mjGEOM_CYLINDER, [shape.radius, shape.length / 2, 0.0]
    if isinstance(shape, Capsule):
        return kinds.mjGEOM_CAPSULE, [shape.radius, shape.length / 2, 0.0]
    if isinstance(shape, Sphere):
        return kinds.mjGEOM_SPHERE, [shape.radius, 0.0, 0.0]
    if isinstance(shape, Ellipsoid):
        return kinds.mjGEOM_ELLIPSOID, list(shape.radii)
    return kinds.mjGEOM_PLANE, [0.0, 0.0, 1.0]  # 0 = infinite


def _tilt(normal: Vector3) -> Quaternion:
    """Return the shortest rotation from +z to ``normal``."""
    length = math.sqrt(sum(c * c for c in normal))
    x, y, z = (c / length for c in normal)
    if z < -1 + 1e-9:
        return (1.0, 0.0, 0.0, 0.0)
    w = 1 + z
    norm = math.sqrt(w * w + x * x + y * y)
    return (-y / norm, x / norm, 0.0, w / norm)
