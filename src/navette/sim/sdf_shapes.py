# SPDX-License-Identifier: Apache-2.0
"""SDF geometry, materials, friction and inertia of a link."""

import math
from dataclasses import replace

from navette.geometry import Transform3
from navette.sim.scene import (
    Box,
    Capsule,
    Colour,
    Cylinder,
    Ellipsoid,
    Geometry,
    Inertial,
    Model,
    Plane,
    Shape,
    Sphere,
)
from navette.sim.sdf_poses import PoseGraph, read_pose
from navette.sim.surface import SURFACES, Surface
from navette.sim.xml_tree import Unsupported, XmlNode

# The most frequent names of Gazebo's material script.
_GAZEBO_COLOURS: dict[str, Colour] = {
    "Grey": (0.5, 0.5, 0.5, 1.0),
    "DarkGrey": (0.25, 0.25, 0.25, 1.0),
    "White": (0.95, 0.95, 0.95, 1.0),
    "Black": (0.1, 0.1, 0.1, 1.0),
    "FlatBlack": (0.1, 0.1, 0.1, 1.0),
    "Red": (0.85, 0.15, 0.15, 1.0),
    "Green": (0.2, 0.7, 0.25, 1.0),
    "Blue": (0.2, 0.3, 0.85, 1.0),
    "Yellow": (0.95, 0.85, 0.2, 1.0),
    "Orange": (0.95, 0.55, 0.15, 1.0),
    "Purple": (0.55, 0.3, 0.7, 1.0),
    "Turquoise": (0.2, 0.75, 0.75, 1.0),
    "Wood": (0.62, 0.44, 0.27, 1.0),
    "Bricks": (0.62, 0.32, 0.26, 1.0),
}


def read_geometries(
    link: XmlNode, graph: PoseGraph, link_name: str, unsupported: Unsupported
) -> tuple[Geometry, ...]:
    """Read collisions and visuals; a visual equal to a collision is merged with it.

    If no visual has a supported shape, such as those of meshes, the collisions are
    visible instead.
    """
    collisions: list[Geometry] = []
    visuals: list[Geometry] = []
    for kind, found in (("collision", collisions), ("visual", visuals)):
        for node in link.all(kind):
            shape = _read_shape(node.need("geometry"), unsupported)
            if shape is None:
                continue
            pose = graph.resolve_in(link_name, read_pose(node))
            found.append(_geometry(node, shape, pose, collides=kind == "collision"))
    if not visuals and link.find("visual") is not None:
        collisions = [replace(shape, visible=True) for shape in collisions]
    return merge_geometries(collisions, visuals)


def _geometry(
    node: XmlNode, shape: Shape, pose: Transform3, *, collides: bool
) -> Geometry:
    return Geometry(
        name=node.attributes.get("name", node.tag),
        shape=shape,
        link_T_shape=pose,
        colour=None if collides else _read_colour(node),
        collides=collides,
        visible=not collides,
        friction=_read_friction(node) if collides else None,
        surface=_read_surface(node),
        is_ground=collides and node.flag("ground"),
    )


def _read_surface(node: XmlNode) -> Surface | None:
    """Read ``<navette:optics>`` of a collision or visual: a name, or numbers."""
    found = node.find("optics")
    if found is None:
        return None
    name = found.text.strip() or "plain"
    if name not in SURFACES:
        known = ", ".join(SURFACES)
        raise found.error(f"{name!r}: expected one of {known}, or attributes")
    surface = SURFACES[name]
    given = found.attributes
    if "reflectivity" in given:
        [share] = found.parse_numbers(given["reflectivity"], 1)
        surface = replace(surface, reflectivity=share)
    if "specular_deg" in given:
        [angle] = found.parse_numbers(given["specular_deg"], 1)
        surface = replace(surface, specular_rad=math.radians(angle))
    return surface


def merge_geometries(
    collisions: list[Geometry], visuals: list[Geometry]
) -> tuple[Geometry, ...]:
    """Merge each pair of collision and visual that coincide."""
    left = list(visuals)
    merged = []
    for collision in collisions:
        twin = next((v for v in left if _coincide(collision, v)), None)
        if twin is not None:
            left.remove(twin)
            surface = twin.surface or collision.surface
            collision = replace(
                collision, colour=twin.colour, visible=True, surface=surface
            )
        merged.append(collision)
    return (*merged, *left)


def made_visible(model: Model, node: XmlNode, unsupported: Unsupported) -> Model:
    """Make collisions visible in an obstacle without any visual.

    A range sensor of Gazebo that is simulated by rendering detects visuals only, so the
    robot would drive into it.
    """
    if model.is_visible or model.drive is not None:
        return model
    unsupported.note_change("model without <visual>: sensors detect <collision>", node)
    return model.with_shapes(lambda shape: replace(shape, visible=True))


def _coincide(a: Geometry, b: Geometry) -> bool:
    if isinstance(a.shape, Plane) and isinstance(b.shape, Plane):
        same = a.shape.normal == b.shape.normal  # the drawn size does not matter
    else:
        same = a.shape == b.shape
    return same and a.link_T_shape == b.link_T_shape


def _read_shape(geometry: XmlNode, unsupported: Unsupported) -> Shape | None:
    for node in geometry.children:
        if node.tag == "box":
            return Box(_positive3(node.need("size")))
        if node.tag == "cylinder":
            return Cylinder(node.positive("radius"), node.positive("length"))
        if node.tag == "capsule":
            return Capsule(node.positive("radius"), node.positive("length"))
        if node.tag == "sphere":
            return Sphere(node.positive("radius"))
        if node.tag == "ellipsoid":
            return Ellipsoid(_positive3(node.need("radii")))
        if node.tag == "plane":
            return _read_plane(node)
        if node.tag != "empty":
            unsupported.note(f"<{node.tag}> geometry", node)
        return None
    raise geometry.error("shape is missing")


def _read_plane(node: XmlNode) -> Plane:
    normal, size = node.find("normal"), node.find("size")
    n = normal.numbers(3) if normal is not None else (0.0, 0.0, 1.0)
    s = size.numbers(2) if size is not None else (100.0, 100.0)
    if normal is not None and sum(c * c for c in n) < 1e-12:
        raise normal.error("a normal of length 0")
    return Plane((n[0], n[1], n[2]), (s[0], s[1]))


def _positive3(node: XmlNode) -> tuple[float, float, float]:
    x, y, z = node.numbers(3)
    if min(x, y, z) <= 0:
        raise node.error(f"{x:g} {y:g} {z:g}: expected three numbers > 0")
    return (x, y, z)


def _read_colour(visual: XmlNode) -> Colour | None:
    for material in visual.all("material"):
        for tag in ("diffuse", "ambient"):
            node = material.find(tag)
            if node is not None and node.text.strip():
                return _colour(node)
        name = material.find("script", "name")
        if name is not None:
            short = name.text.strip().removeprefix("Gazebo/")
            return _GAZEBO_COLOURS.get(short, _GAZEBO_COLOURS["Grey"])
    return None


def _colour(node: XmlNode) -> Colour:
    count = len(node.text.split())
    values = node.numbers(3 if count == 3 else 4)
    r, g, b, a = (*values, 1.0)[:4]
    return (_unit(r), _unit(g), _unit(b), _unit(a))


def _unit(value: float) -> float:
    return min(1.0, max(0.0, value))


def _read_friction(collision: XmlNode) -> float | None:
    node = collision.find("surface", "friction", "ode")
    if node is None or node.find("mu") is None:
        return None
    friction = node.number("mu")
    if friction < 0:
        raise node.error(f"<mu> is {friction:g}; must be >= 0")
    return friction


def read_inertial(link: XmlNode, graph: PoseGraph, link_name: str) -> Inertial:
    """Read mass and inertia; SDF's defaults are 1 kg and 1 kg m²."""
    node = link.find("inertial")
    if node is None:
        return Inertial(1.0, Transform3.identity(), (1.0, 1.0, 1.0, 0.0, 0.0, 0.0))
    link_T_com = graph.resolve_in(link_name, read_pose(node))
    inertia = node.find("inertia")
    defaults = {"ixx": 1.0, "iyy": 1.0, "izz": 1.0, "ixy": 0.0, "ixz": 0.0, "iyz": 0.0}
    xx, yy, zz, xy, xz, yz = (
        inertia.number(key, default) if inertia else default
        for key, default in defaults.items()
    )
    return Inertial(node.positive("mass", 1.0), link_T_com, (xx, yy, zz, xy, xz, yz))
