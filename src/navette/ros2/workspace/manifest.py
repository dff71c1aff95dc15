"""Reader of package.xml (REP 127, 140, 149)."""

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

from navette.errors import FileFormatError
from navette.files.untrusted.budget import DOCUMENT
from navette.files.untrusted.files import read_bounded
from navette.files.untrusted.xml_input import parse_xml

FILE_NAME = "package.xml"
_NAME = re.compile(r"[a-zA-Z0-9][a-zA-Z0-9_-]+", re.ASCII)
_DEPENDENCY_TAGS = (
    "depend",
    "build_depend",
    "build_export_depend",
    "exec_depend",
    "run_depend",
)


@dataclass(frozen=True, slots=True)
class Manifest:
    """The parts of a package.xml that Navette uses."""

    name: str
    version: str
    description: str
    build_type: str
    #: Packages required to build or run, in the file's order; not those of tests.
    dependencies: tuple[str, ...]


class _Elements:
    """Creates the elements of a file."""

    def node(self, tag: str, attributes: dict[str, str], line: int) -> Element:
        return Element(tag, attributes)

    def add(self, parent: Element, child: Element) -> None:
        parent.append(child)

    def text(self, node: Element, text: str) -> None:
        node.text = text


def read_manifest(path: Path) -> Manifest:
    """Read a package.xml.

    Raises:
        FileFormatError: the file is not XML, or has no package with a valid name.
    """
    root = parse_xml(read_bounded(path, DOCUMENT), path, _Elements())
    if root.tag != "package":
        raise FileFormatError(path, f"<{root.tag}>: expected <package>")
    name = _text(root, "name")
    if not is_package_name(name):
        raise FileFormatError(path, f"<name> {name!r} is not a valid package name")
    names = (e.text or "" for tag in _DEPENDENCY_TAGS for e in root.iter(tag))
    return Manifest(
        name=name,
        version=_text(root, "version"),
        description=" ".join(_text(root, "description").split()),
        build_type=_text(root, "export/build_type") or "catkin",
        dependencies=tuple(dict.fromkeys(each.strip() for each in names)),
    )


def is_package_name(name: str) -> bool:
    """Whether REP 127 and its recommended exemptions allow the name."""
    return _NAME.fullmatch(name) is not None


def _text(root: Element, tag: str) -> str:
    return (root.findtext(tag) or "").strip()
