# SPDX-License-Identifier: Apache-2.0
"""URDF shapes and materials."""

from navette.geometry import Transform3
from navette.sim.scene import Box, Capsule, Colour, Cylinder, Geometry, Shape, Sphere
from navette.sim.xml_tree import Unsupported, XmlNode


class Materials:
    """Named colours of a URDF; a name may be used before its definition."""

    def __init__(self, root: XmlNode) -> None:
        self._colours: dict[str, Colour] = {}
        for owner in (
            root,
            *(v for link in root.all("link") for v in link.all("visual")),
        ):
            for node in owner.all("material"):
                colour = _own_colour(node)
                if colour is not None and "name" in node.attributes:
                    self._colours.setdefault(node.attributes["name"], colour)

    def colour_of(self, visual: XmlNode) -> Colour | None:
        node = visual.find("material")
        if node is None:
            return None
        return _own_colour(node) or self._colours.get(node.attributes.get("name", ""))


def _own_colour(material: XmlNode) -> Colour | None:
    node = material.find("color")
    if node is not None:
        text = node.need_attribute("rgba")
    else:
        node = material.find("diffuse")  # SDF syntax, found in URDF files too
        if node is None:
            return None
        text = node.text
    r, g, b, a = (min(1.0, max(0.0, c)) for c in node.parse_numbers(text, 4))
    return (r, g, b, a)


def read_urdf_geometry(
    element: XmlNode,
    link_T_shape: Transform3,
    materials: Materials,
    unsupported: Unsupported,
) -> Geometry | None:
    """Read a ``<collision>`` or ``<visual>``; None if its shape is not supported."""
    shape = _shape(element.need("geometry"), unsupported)
    if shape is None:
        return None
    solid = element.tag == "collision"
    return Geometry(
        name=element.attributes.get("name", element.tag),
        shape=shape,
        link_T_shape=link_T_shape,
        colour=None if solid else materials.colour_of(element),
        collides=solid,
        visible=not solid,
    )


def _shape(geometry: XmlNode, unsupported: Unsupported) -> Shape | None:
    if not geometry.children:
        raise geometry.error("shape is missing")
    node = geometry.children[0]
    if node.tag == "box":
        x, y, z = _positive(node, "size", 3)
        return Box((x, y, z))
    if node.tag == "cylinder":
        return Cylinder(
            _positive(node, "radius", 1)[0], _positive(node, "length", 1)[0]
        )
    if node.tag == "capsule":
        return Capsule(_positive(node, "radius", 1)[0], _positive(node, "length", 1)[0])
    if node.tag == "sphere":
        return Sphere(_positive(node, "radius", 1)[0])
    unsupported.note(f"<{node.tag}> geometry", node)
    return None


def _positive(node: XmlNode, key: str, count: int) -> tuple[float, ...]:
    values = node.parse_numbers(node.need_attribute(key), count)
    if min(values) <= 0:
        raise node.error(f"{key} {node.attributes[key]!r}: must be > 0")
    return values
