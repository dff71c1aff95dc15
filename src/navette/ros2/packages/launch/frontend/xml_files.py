"""Reader of XML launch files; refuses document types, entities and external files."""

from dataclasses import dataclass
from pathlib import Path

from navette.files.untrusted.xml_input import parse_xml
from navette.ros2.packages.launch.frontend.element import Element


@dataclass(frozen=True)
class _Elements:
    """Creates the elements of a file."""

    path: Path

    def node(self, tag: str, attributes: dict[str, str], line: int) -> Element:
        return Element(tag, self.path, line, dict(attributes))

    def add(self, parent: Element, child: Element) -> None:
        parent.add(child)

    def text(self, node: Element, text: str) -> None:
        if text.strip():
            raise node.error(f"unexpected text {text.strip()[:40]!r}")


def read_xml(text: bytes, path: Path) -> Element:
    """Return the root element of a file's text.

    Raises:
        FileFormatError: invalid or unsafe XML; names the line.
    """
    return parse_xml(text, path, _Elements(path))
