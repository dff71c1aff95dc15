# SPDX-License-Identifier: Apache-2.0
"""URDF of the robot and of the world, for viewers."""

import math
from xml.etree import ElementTree as Xml

import mujoco
import numpy as np

from navette.geometry import Quaternion, Transform3
from navette.sim.build import Compiled
from navette.sim.frames import RobotFrames
from navette.sim.scene import (
    Box,
    Capsule,
    Colour,
    Cylinder,
    Ellipsoid,
    Geometry,
    Link,
    Plane,
    Shape,
    Sphere,
)

_FLOOR_M = 0.02  # planes are drawn as thin boxes
_GREY: Colour = (0.7, 0.7, 0.72, 1.0)


def describe_robot(compiled: Compiled, frames: RobotFrames) -> str:
    """URDF of the robot: its root is the base frame, its links are named by frames."""
    robot = compiled.robot
    root = Xml.Element("robot", name=robot.model.name)
    _add_link(root, frames.base, None)
    base_T_model = robot.model_T_base.inverse()
    for link in robot.model.links:
        frame = frames.of_link(link.name)
        if frame == frames.base:
            root.remove(root[0])
            _add_link(root, frame, link)
            continue
        _add_link(root, frame, link)
        kind = "floating" if link.name in frames.moving else "fixed"
        joint = Xml.SubElement(root, "joint", name=f"to {frame}", type=kind)
        Xml.SubElement(joint, "parent", link=frames.base)
        Xml.SubElement(joint, "child", link=frame)
        _add_origin(joint, base_T_model @ link.model_T_link)
    return _text(root)


def describe_world(compiled: Compiled, map_frame: str) -> str:
    """URDF of all static models, as one link in the map frame."""
    model = compiled.model
    root = Xml.Element("robot", name=compiled.scene.name)
    link = Xml.SubElement(root, "link", name=map_frame)
    fixed = np.flatnonzero((model.geom_bodyid == 0) & (model.geom_group <= 1))
    for index in fixed.tolist():
        shape = _shape_of(model, index)
        if shape is not None:
            w, x, y, z = model.geom_quat[index].tolist()
            px, py, pz = model.geom_pos[index].tolist()
            r, g, b, a = model.geom_rgba[index].tolist()
            pose = Transform3((px, py, pz), (x, y, z, w))
            name = compiled.geom_owner[index]
            _add_visual(link, shape, pose, (r, g, b, a), name)
    return _text(root)


def _shape_of(model: mujoco.MjModel, index: int) -> Shape | None:
    a, b, c = model.geom_size[index].tolist()
    kind = model.geom_type[index]
    kinds = mujoco.mjtGeom
    if kind == kinds.mjGEOM_BOX:
        return Box((2 * a, 2 * b, 2 * c))
    if kind == kinds.mjGEOM_CYLINDER:
        return Cylinder(a, 2 * b)
    if kind == kinds.mjGEOM_SPHERE:
        return Sphere(a)
    if kind == kinds.mjGEOM_CAPSULE:
        return Capsule(a, 2 * b)
    if kind == kinds.mjGEOM_ELLIPSOID:
        return Ellipsoid((a, b, c))
    return Plane() if kind == kinds.mjGEOM_PLANE else None


def _text(root: Xml.Element) -> str:
    Xml.indent(root)
    return '<?xml version="1.0"?>\n' + Xml.tostring(root, encoding="unicode")


def _add_link(root: Xml.Element, frame: str, link: Link | None) -> None:
    element = Xml.SubElement(root, "link", name=frame)
    for geometry in link.geometries if link else ():
        if geometry.visible:
            _add_geometry(element, geometry)


def _add_geometry(element: Xml.Element, geometry: Geometry) -> None:
    colour = geometry.colour or _GREY
    _add_visual(element, geometry.shape, geometry.link_T_shape, colour)


def _add_visual(
    link: Xml.Element,
    shape: Shape,
    pose: Transform3,
    colour: Colour,
    name: str = "",
) -> None:
    """Compose a shape of boxes, cylinders and spheres, which URDF has."""
    if isinstance(shape, Capsule):
        tip = Transform3((0.0, 0.0, shape.length / 2), (0.0, 0.0, 0.0, 1.0))
        _add_visual(link, Cylinder(shape.radius, shape.length), pose, colour, name)
        for end in (tip, tip.inverse()):
            _add_visual(link, Sphere(shape.radius), pose @ end, colour, name)
        return
    visual = Xml.SubElement(link, "visual", {"name": name} if name else {})
    if isinstance(shape, Plane):
        below = Transform3((0.0, 0.0, -_FLOOR_M / 2), (0.0, 0.0, 0.0, 1.0))
        pose, shape = pose @ below, Box((*shape.size, _FLOOR_M))
    _add_origin(visual, pose)
    geometry = Xml.SubElement(visual, "geometry")
    if isinstance(shape, Box):
        Xml.SubElement(geometry, "box", size=_join(shape.size))
    elif isinstance(shape, Cylinder):
        radius, length = _number(shape.radius), _number(shape.length)
        Xml.SubElement(geometry, "cylinder", radius=radius, length=length)
    elif isinstance(shape, Ellipsoid):
        Xml.SubElement(geometry, "sphere", radius=_number(min(shape.radii)))
    else:
        Xml.SubElement(geometry, "sphere", radius=_number(shape.radius))
    name = "rgba " + _join(colour)
    material = Xml.SubElement(visual, "material", name=name)
    Xml.SubElement(material, "color", rgba=_join(colour))


def _add_origin(owner: Xml.Element, pose: Transform3) -> None:
    Xml.SubElement(
        owner, "origin", xyz=_join(pose.translation), rpy=_join(_rpy(pose.rotation))
    )


def _rpy(q: Quaternion) -> tuple[float, float, float]:
    """Roll, pitch, yaw (rad) about fixed axes, as in URDF."""
    x, y, z, w = q
    sine = 2 * (w * y - z * x)
    if abs(sine) > 1 - 1e-12:  # pitch ±90°: yaw is undetermined, use 0
        return (2 * math.atan2(x, w), math.copysign(math.pi / 2, sine), 0.0)
    return (
        math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
        math.asin(sine),
        math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
    )


def _join(values: tuple[float, ...]) -> str:
    return " ".join(map(_number, values))


def _number(value: float) -> str:
    return f"{round(value, 6) + 0.0:g}"
