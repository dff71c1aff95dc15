# SPDX-License-Identifier: Apache-2.0
"""Reads SDF worlds and models (1.5 to 1.10; http://sdformat.org/spec).

Supported: world, model (nested too), actor, link, frame, joint (fixed, revolute,
continuous, prismatic, ball), collision and visual with primitive shapes, sensors,
drive plugins, gravity. Other elements are ignored with one warning per kind.
"""

from dataclasses import replace
from pathlib import Path

from navette.geometry import Transform3, Vector3
from navette.geometry.se3 import rotate
from navette.sim.limits import check_parts
from navette.sim.scene import (
    AckermannDrive,
    DiffDrive,
    Geometry,
    GeoOrigin,
    Joint,
    JointKind,
    Link,
    Model,
    Plane,
    Scene,
)
from navette.sim.sdf_actors import MAX_ACTORS, read_actor
from navette.sim.sdf_drives import find_drive, note_plugin
from navette.sim.sdf_poses import PoseGraph, RawPose, read_pose
from navette.sim.sdf_sensors import read_sensors
from navette.sim.sdf_shapes import made_visible, read_geometries, read_inertial
from navette.sim.xml_tree import Unsupported, XmlNode, parse_xml

START_FRAME = "robot_start"
MAX_MODELS = 20_000

_IGNORED_IN_WORLD = {
    *("physics", "gui", "scene", "light", "gravity", "magnetic_field", "atmosphere"),
    *("spherical_coordinates", "state", "audio", "wind", "model", "frame", "plugin"),
    *("include", "actor"),
}
_KNOWN_IN_MODEL = {
    *("static", "self_collide", "allow_auto_disable", "pose", "link", "joint", "frame"),
    *("model", "plugin", "enable_wind"),
}
_KNOWN_IN_LINK = {
    *("pose", "inertial", "collision", "visual", "sensor", "gravity", "kinematic"),
    *("self_collide", "enable_wind", "must_be_base_link", "velocity_decay", "light"),
}
_KINDS = {
    "fixed": JointKind.FIXED,
    "revolute": JointKind.REVOLUTE,
    "continuous": JointKind.REVOLUTE,
    "prismatic": JointKind.PRISMATIC,
    "ball": JointKind.BALL,
}
_UNLIMITED = 1e16  # files express "no limit" as 1e16, 1e308 or inf


def read_sdf(path: Path) -> Scene:
    """Read a world (or a file with models only) into a scene.

    Raises:
        FileFormatError: with file and line.
    """
    root = parse_xml(path)
    if root.tag != "sdf":
        raise root.error("the root element must be <sdf>")
    check_parts(root)
    unsupported = Unsupported(path)
    worlds = list(root.all("world"))
    for extra in worlds[1:]:
        unsupported.note("a second <world>", extra)
    scene = _read_world(worlds[0] if worlds else root, path, unsupported)
    unsupported.report()
    return scene


def _read_world(world: XmlNode, path: Path, unsupported: Unsupported) -> Scene:
    graph = PoseGraph("world")
    raw: list[tuple[Model, RawPose]] = []
    for node in world.all("model"):
        if len(raw) >= MAX_MODELS:
            raise node.error(f"more than {MAX_MODELS} models")
        model = made_visible(_read_model(node, unsupported), node, unsupported)
        pose = read_pose(node)
        graph.add(model.name, pose)
        for link in model.links:
            name = f"{model.name}::{link.name}"
            graph.add_fixed(name, model.name, link.model_T_link, node)
        raw.append((model, pose))
    for node in world.all("frame"):
        graph.add(node.name(), read_pose(node), node.attributes.get("attached_to", ""))
    models = [m.at(graph.pose_of(m.name, pose.node)) for m, pose in raw]
    models += _read_includes(world, unsupported)
    models += _read_actors(world, {m.name for m in models}, unsupported)
    _note_unknown(world, unsupported)
    start = next((n for n in world.all("frame") if n.name() == START_FRAME), None)
    return Scene(
        name=world.attributes.get("name", path.stem),
        models=tuple(models),
        gravity=_vector(world, "gravity", (0.0, 0.0, -9.81)),
        start=graph.pose_of(START_FRAME, start) if start else Transform3.identity(),
        origin=_read_origin(world),
    )


def _read_origin(world: XmlNode) -> GeoOrigin:
    """Read where the world's frame lies on the Earth (``<spherical_coordinates>``)."""
    node = world.find("spherical_coordinates")
    if node is None:
        return GeoOrigin()
    latitude = node.number("latitude_deg", 0.0)
    if abs(latitude) > 90.0:
        raise node.error(f"<latitude_deg> is {latitude:g}; expected -90 to 90")
    return GeoOrigin(
        latitude,
        node.number("longitude_deg", 0.0),
        node.number("elevation", 0.0),
        node.number("heading_deg", 0.0),
    )


def _vector(owner: XmlNode, tag: str, default: Vector3) -> Vector3:
    node = owner.find(tag)
    if node is None or not node.text.strip():
        return default
    x, y, z = node.numbers(3)
    return (x, y, z)


def _read_includes(world: XmlNode, unsupported: Unsupported) -> list[Model]:
    """Handle <include>: only ground_plane and sun are built in, others are ignored."""
    models = []
    for node in world.all("include"):
        uri = node.words("uri")
        short = uri.rstrip("/").rpartition("/")[2].lower().replace(" ", "_")
        if short == "ground_plane":
            plane = Geometry(name="collision", shape=Plane())
            link = Link(name="link", geometries=(plane,))
            models.append(Model(name="ground_plane", static=True, links=(link,)))
        elif short != "sun":
            unsupported.note(f"<include> of {uri!r}", node)
    return models


def _read_actors(
    world: XmlNode, taken: set[str], unsupported: Unsupported
) -> list[Model]:
    actors: list[Model] = []
    for node in world.all("actor"):
        if len(actors) >= MAX_ACTORS:
            raise node.error(f"more than {MAX_ACTORS} actors")
        if node.name() in taken:
            raise node.error(f"the name {node.name()!r} is used twice")
        taken.add(node.name())
        graph = PoseGraph("__model__")
        _fill_graph(node, graph, [])
        links = [_read_link(child, graph, unsupported) for child in node.all("link")]
        actors.append(read_actor(node, tuple(links), unsupported))
    return actors


def _note_unknown(world: XmlNode, unsupported: Unsupported) -> None:
    for node in world.children:
        if node.tag not in _IGNORED_IN_WORLD:
            unsupported.note(f"<{node.tag}> in <{world.tag}>", node)
        elif node.tag == "plugin":
            note_plugin(node, unsupported)


def _read_model(node: XmlNode, unsupported: Unsupported) -> Model:
    """Read a model with all poses resolved to its own frame, without its own pose."""
    name = node.name()
    graph = PoseGraph("__model__")
    nested = [_read_model(child, unsupported) for child in node.all("model")]
    _fill_graph(node, graph, nested)
    for child in node.children:
        if child.tag not in _KNOWN_IN_MODEL:
            unsupported.note(f"<{child.tag}> in <model>", child)
    links = [_read_link(child, graph, unsupported) for child in node.all("link")]
    joints = [_read_joint(child, graph, unsupported) for child in node.all("joint")]
    drive = find_drive(node.all("plugin"), joints, unsupported)
    for inner in nested:
        model_T_inner = graph.pose_of(inner.name, node)
        links += [_lift_link(link, inner.name, model_T_inner) for link in inner.links]
        joints += [_lift_joint(j, inner.name, model_T_inner) for j in inner.joints]
        drive = drive or (_lift_drive(inner.drive, inner.name) if inner.drive else None)
    known = {link.name for link in links} | {"world"}
    for joint in joints:
        for end in (joint.parent, joint.child):
            if end not in known:
                raise node.error(f"joint {joint.name!r} refers to unknown link {end!r}")
    return Model(
        name=name,
        static=node.flag("static"),
        links=tuple(links),
        joints=tuple(joints),
        drive=drive,
    )


def _fill_graph(node: XmlNode, graph: PoseGraph, nested: list[Model]) -> None:
    for child in node.all("link"):
        graph.add(child.name(), read_pose(child))
    for child in node.all("frame"):
        graph.add(
            child.name(), read_pose(child), child.attributes.get("attached_to", "")
        )
    for child in node.all("joint"):
        graph.add(child.name(), read_pose(child), child.words("child"))
    for child, inner in zip(node.all("model"), nested, strict=True):
        graph.add(inner.name, read_pose(child))
        for link in inner.links:
            scoped = f"{inner.name}::{link.name}"
            graph.add_fixed(scoped, inner.name, link.model_T_link, child)


def _read_link(node: XmlNode, graph: PoseGraph, unsupported: Unsupported) -> Link:
    name = node.name()
    for child in node.children:
        if child.tag not in _KNOWN_IN_LINK:
            unsupported.note(f"<{child.tag}> in <link>", child)
    return Link(
        name=name,
        model_T_link=graph.pose_of(name, node),
        inertial=read_inertial(node, graph, name),
        geometries=read_geometries(node, graph, name, unsupported),
        sensors=read_sensors(node, graph, name, unsupported),
    )


def _read_joint(node: XmlNode, graph: PoseGraph, unsupported: Unsupported) -> Joint:
    kind = node.need_attribute("type")
    if kind not in _KINDS:
        unsupported.note(f"joint of type {kind!r} (treated as fixed)", node)
    name = node.name()
    model_T_joint = graph.pose_of(name, node)
    axis, limits, damping, friction = (0.0, 0.0, 1.0), None, 0.0, 0.0
    element = node.find("axis")
    if element is not None:
        axis = _read_axis(element, graph, model_T_joint)
        limits = None if kind == "continuous" else _read_limits(element)
        dynamics = element.find("dynamics")
        if dynamics is not None:
            damping = dynamics.number("damping", 0.0)
            friction = dynamics.number("friction", 0.0)
    return Joint(
        name=name,
        kind=_KINDS.get(kind, JointKind.FIXED),
        parent=node.need("parent").text.strip(),
        child=node.need("child").text.strip(),
        model_T_joint=model_T_joint,
        axis=axis,
        limits=limits,
        damping=damping,
        friction=friction,
    )


def _read_axis(
    element: XmlNode, graph: PoseGraph, model_T_joint: Transform3
) -> Vector3:
    node = element.need("xyz")
    x, y, z = node.numbers(3)
    if x * x + y * y + z * z < 1e-12:
        raise node.error("an axis of length 0")
    given_in = node.attributes.get("expressed_in", "")
    if element.flag("use_parent_model_frame"):
        given_in = "__model__"
    if not given_in:
        return (x, y, z)
    axis_model = rotate(graph.pose_of(given_in, node).rotation, (x, y, z))
    return rotate(model_T_joint.inverse().rotation, axis_model)


def _read_limits(element: XmlNode) -> tuple[float, float] | None:
    node = element.find("limit")
    if node is None:
        return None

    def bound(tag: str, default: float) -> float:
        text = node.words(tag)
        if text.lower().lstrip("+-") in ("inf", "infinity"):
            return default
        return node.number(tag, default)

    lower, upper = bound("lower", -_UNLIMITED), bound("upper", _UNLIMITED)
    if lower <= -_UNLIMITED or upper >= _UNLIMITED:
        return None
    if lower > upper:
        raise node.error(f"lower {lower:g} is above upper {upper:g}")
    return (lower, upper)


def _lift_link(link: Link, inner: str, model_T_inner: Transform3) -> Link:
    pose = model_T_inner @ link.model_T_link
    return replace(link, name=f"{inner}::{link.name}", model_T_link=pose)


def _lift_joint(joint: Joint, inner: str, model_T_inner: Transform3) -> Joint:
    def lifted(end: str) -> str:
        return end if end == "world" else f"{inner}::{end}"

    return replace(
        joint,
        name=f"{inner}::{joint.name}",
        parent=lifted(joint.parent),
        child=lifted(joint.child),
        model_T_joint=model_T_inner @ joint.model_T_joint,
    )


def _lift_drive(drive: DiffDrive, inner: str) -> DiffDrive:
    if isinstance(drive, AckermannDrive):
        drive = replace(
            drive,
            left_steering=f"{inner}::{drive.left_steering}",
            right_steering=f"{inner}::{drive.right_steering}",
        )
    return replace(
        drive,
        left_joints=tuple(f"{inner}::{name}" for name in drive.left_joints),
        right_joints=tuple(f"{inner}::{name}" for name in drive.right_joints),
    )
