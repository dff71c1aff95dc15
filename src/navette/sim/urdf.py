# SPDX-License-Identifier: Apache-2.0
"""Reads URDF robots and environments (http://wiki.ros.org/urdf/XML).

Drive plugins and sensors come from the ``<gazebo>`` extension, as in Gazebo.
"""

from dataclasses import replace
from pathlib import Path

from navette.errors import FileFormatError
from navette.geometry import Transform3, quaternion_from_rpy
from navette.sim.limits import check_parts
from navette.sim.scene import (
    Geometry,
    Inertial,
    Joint,
    JointKind,
    Link,
    Model,
    Scene,
)
from navette.sim.sdf_drives import find_drive
from navette.sim.sdf_poses import PoseGraph
from navette.sim.sdf_sensors import read_sensors
from navette.sim.sdf_shapes import made_visible, merge_geometries
from navette.sim.urdf_shapes import Materials, read_urdf_geometry
from navette.sim.xml_tree import Unsupported, XmlNode, parse_xml

_KINDS = {
    "fixed": JointKind.FIXED,
    "revolute": JointKind.REVOLUTE,
    "continuous": JointKind.REVOLUTE,
    "prismatic": JointKind.PRISMATIC,
}
_KNOWN = {"link", "joint", "material", "gazebo", "transmission"}


def read_urdf_world(path: Path) -> Scene:
    """Read a URDF as a world: static, unless it has a robot with a drive."""
    model = _read(path)
    if model.drive is None:
        model = replace(_solid(model), static=True)
    return Scene(name=model.name, models=(model,))


def read_urdf_robot(path: Path) -> Model:
    """Read a URDF robot; requires a diff-drive plugin in its ``<gazebo>`` extension."""
    model = _read(path)
    if model.drive is None:
        raise FileFormatError(
            path, "no differential drive plugin in a <gazebo> element"
        )
    return model


def _solid(model: Model) -> Model:
    """Make visuals solid in a model without any collision, made for viewing."""
    if any(g.collides for link in model.links for g in link.geometries):
        return model
    return model.with_shapes(lambda shape: replace(shape, collides=True))


def _read(path: Path) -> Model:
    root = parse_xml(path)
    if root.tag != "robot":
        raise root.error("the root element must be <robot>")
    check_parts(root)
    unsupported = Unsupported(path)
    for node in root.children:
        if node.tag not in _KNOWN:
            unsupported.note(f"<{node.tag}> in <robot>", node)
    joint_nodes = list(root.all("joint"))
    poses = _link_poses(root, joint_nodes, unsupported)
    joints = tuple(_read_joint(node, poses, unsupported) for node in joint_nodes)
    graph = PoseGraph("__model__")
    for name, pose in poses.items():
        graph.add_fixed(name, "__model__", pose, root)
    materials = Materials(root)
    links = tuple(
        _read_link(node, poses, materials, graph, root, unsupported)
        for node in root.all("link")
    )
    plugins = (p for node in root.all("gazebo") for p in node.all("plugin"))
    drive = find_drive(plugins, joints, unsupported)
    model = Model(name=root.name(), links=links, joints=joints, drive=drive)
    model = made_visible(model, root, unsupported)
    unsupported.report()
    return model


def _origin(owner: XmlNode) -> Transform3:
    node = owner.find("origin")
    if node is None:
        return Transform3.identity()
    x, y, z = node.parse_numbers(node.attributes.get("xyz", "0 0 0"), 3)
    rpy = node.parse_numbers(node.attributes.get("rpy", "0 0 0"), 3)
    return Transform3((x, y, z), quaternion_from_rpy(*rpy))


def _link_poses(
    root: XmlNode, joints: list[XmlNode], unsupported: Unsupported
) -> dict[str, Transform3]:
    """``model_T_link`` of every link; the model frame is the first root link."""
    links = {node.name(): node for node in root.all("link")}
    if not links:
        raise root.error("the robot has no links")
    carrier = _carriers(joints, links)
    poses: dict[str, Transform3] = {}
    for name in links:
        chain: list[str] = []
        while name not in poses and name in carrier:
            if name in chain:
                raise carrier[name].error("joints form a cycle")
            chain.append(name)
            name = _end(carrier[name], "parent")
        if name not in poses:
            if poses:
                kind = "link without a joint (placed at the origin)"
                unsupported.note(kind, links[name])
            poses[name] = Transform3.identity()
        for child in reversed(chain):
            poses[child] = poses[name] @ _origin(carrier[child])
            name = child
    return poses


def _carriers(joints: list[XmlNode], links: dict[str, XmlNode]) -> dict[str, XmlNode]:
    """Return the parent joint of each link."""
    carrier: dict[str, XmlNode] = {}
    for node in joints:
        child = _end(node, "child")
        for end in (_end(node, "parent"), child):
            if end not in links:
                raise node.error(f"no link {end!r}")
        if child in carrier:
            raise node.error(f"link {child!r} is the child of two joints")
        carrier[child] = node
    return carrier


def _end(joint: XmlNode, tag: str) -> str:
    return joint.need(tag).need_attribute("link")


def _read_joint(
    node: XmlNode, poses: dict[str, Transform3], unsupported: Unsupported
) -> Joint:
    kind = node.need_attribute("type")
    if kind not in _KINDS:
        unsupported.note(f"joint of type {kind!r} (treated as fixed)", node)
    child = _end(node, "child")
    axis = node.find("axis")
    x, y, z = (
        axis.parse_numbers(axis.attributes.get("xyz", "1 0 0"), 3)
        if axis is not None
        else (1.0, 0.0, 0.0)
    )
    if x * x + y * y + z * z < 1e-12:
        raise node.error("an axis of length 0")
    dynamics = node.find("dynamics")
    numbers = dynamics.attributes if dynamics is not None else {}
    return Joint(
        name=node.name(),
        kind=_KINDS.get(kind, JointKind.FIXED),
        parent=_end(node, "parent"),
        child=child,
        model_T_joint=poses[child],
        axis=(x, y, z),
        limits=_limits(node) if kind in ("revolute", "prismatic") else None,
        damping=node.parse_numbers(numbers.get("damping", "0"), 1)[0],
        friction=node.parse_numbers(numbers.get("friction", "0"), 1)[0],
    )


def _limits(node: XmlNode) -> tuple[float, float] | None:
    limit = node.find("limit")
    if limit is None or "lower" not in limit.attributes:
        return None
    lower = limit.parse_numbers(limit.attributes["lower"], 1)[0]
    upper = limit.parse_numbers(limit.attributes.get("upper", "0"), 1)[0]
    if lower > upper:
        raise limit.error(f"lower {lower:g} is above upper {upper:g}")
    return (lower, upper)


def _read_link(
    node: XmlNode,
    poses: dict[str, Transform3],
    materials: Materials,
    graph: PoseGraph,
    root: XmlNode,
    unsupported: Unsupported,
) -> Link:
    name = node.name()
    extensions = [
        g for g in root.all("gazebo") if g.attributes.get("reference") == name
    ]
    friction = next(
        (g.number("mu1") for g in extensions if g.find("mu1") is not None), None
    )
    found: dict[str, list[Geometry]] = {"collision": [], "visual": []}
    for kind, geometries in found.items():
        for element in node.all(kind):
            geometry = read_urdf_geometry(
                element, _origin(element), materials, unsupported
            )
            if geometry is not None:
                solid = geometry.collides
                geometries.append(
                    replace(geometry, friction=friction if solid else None)
                )
    return Link(
        name=name,
        model_T_link=poses[name],
        inertial=_inertial(node),
        geometries=merge_geometries(found["collision"], found["visual"]),
        sensors=tuple(
            sensor
            for extension in extensions
            for sensor in read_sensors(extension, graph, name, unsupported)
        ),
    )


def _inertial(link: XmlNode) -> Inertial | None:
    node = link.find("inertial")
    if node is None:
        return None
    mass = node.need("mass")
    kilograms = mass.parse_numbers(mass.need_attribute("value"), 1)[0]
    if kilograms <= 0:
        raise mass.error(f"{kilograms:g} kg; must be > 0")
    inertia = node.need("inertia")
    xx, yy, zz, xy, xz, yz = (
        inertia.parse_numbers(inertia.attributes.get(key, "0"), 1)[0]
        for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    )
    return Inertial(kilograms, _origin(node), (xx, yy, zz, xy, xz, yz))
