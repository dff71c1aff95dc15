"""Reader of XML launch files; refuses document types, entities and external files."""

from pathlib import Path
from xml.etree.ElementTree import ParseError

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import DefusedXMLParser

from navette.errors import FileFormatError
from navette.ros2.packages.launch.frontend.element import Element

MAX_ELEMENTS = 100_000
MAX_DEPTH = 64


class _Builder:
    """Parser target: creates elements with lines, up to a maximum size."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.expat: object = None
        self.root: Element | None = None
        self._open: list[Element] = []
        self._count = 0

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        line = int(getattr(self.expat, "CurrentLineNumber", 0))
        element = Element(tag, self.path, line, dict(attributes))
        self._count += 1
        if self._count > MAX_ELEMENTS or len(self._open) >= MAX_DEPTH:
            raise element.error(
                f"more than {MAX_ELEMENTS} elements, or nested deeper than {MAX_DEPTH}"
            )
        if self._open:
            self._open[-1].children.append(element)
        else:
            self.root = element
        self._open.append(element)

    def end(self, tag: str) -> None:
        self._open.pop()

    def data(self, text: str) -> None:
        if text.strip():
            raise self._open[-1].error(f"unexpected text {text.strip()[:40]!r}")

    def close(self) -> Element | None:
        return self.root


def read_xml(text: bytes, path: Path) -> Element:
    """Return the root element of a file's text.

    Raises:
        FileFormatError: invalid or unsafe XML; names the line.
    """
    builder = _Builder(path)
    parser = DefusedXMLParser(target=builder, forbid_dtd=True)
    builder.expat = parser.parser
    try:
        parser.feed(text)
        root = parser.close()
    except ParseError as error:
        raise FileFormatError(
            path, f"not XML: {error.msg}", error.position[0]
        ) from None
    except DefusedXmlException as error:
        raise FileFormatError(path, f"refused: {type(error).__name__}") from None
    if not isinstance(root, Element):
        raise FileFormatError(path, "not XML: no element")
    return root
