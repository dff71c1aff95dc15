# SPDX-License-Identifier: Apache-2.0
"""MuJoCo model files as worlds: checked here, compiled by MuJoCo."""

from pathlib import Path

from navette.sim.limits import PartCounter, check_mjcf_parts
from navette.sim.scene import Scene
from navette.sim.xml_tree import XmlNode, parse_xml

_FILE_ATTRIBUTES = ("file", "meshdir", "texturedir", "assetdir", "fileright")
_REFUSED = ("plugin", "extension")


def read_mjcf(path: Path) -> Scene:
    """Read a world from an MJCF file; MuJoCo itself parses the contents.

    Raises:
        FileFormatError: not MJCF, unsafe XML, plugins, or files outside its folder.
    """
    root = parse_xml(path)
    if root.tag != "mujoco":
        raise root.error("the root element must be <mujoco>")
    _check(root, {path.resolve()}, PartCounter())
    return Scene(name=root.attributes.get("model", path.stem), mjcf=path)


def _check(root: XmlNode, seen: set[Path], counter: PartCounter) -> None:
    """Check the file of ``root`` and the files it includes."""
    check_mjcf_parts(root, counter)
    _check_node(root, seen, counter)


def _check_node(node: XmlNode, seen: set[Path], counter: PartCounter) -> None:
    if node.tag in _REFUSED:
        raise node.error("plugins are not allowed")
    for key in _FILE_ATTRIBUTES:
        value = node.attributes.get(key, "")
        if value and (Path(value).is_absolute() or ".." in Path(value).parts):
            raise node.error(f"{key}={value!r} is outside the file's folder")
    for child in node.children:
        _check_node(child, seen, counter)
    if node.tag == "include" and "file" in node.attributes:
        inner = (node.path.parent / node.attributes["file"]).resolve()
        if inner in seen:
            raise node.error(f"{inner.name!r} is included twice")
        _check(parse_xml(inner), seen | {inner}, counter)
