"""XML parser for untrusted text, with the line of every element.

``defusedxml`` refuses document types, entities and external references; the budget
limits elements, pieces of text and nesting.
"""

from pathlib import Path
from typing import Generic, Protocol, TypeVar
from xml.etree.ElementTree import ParseError

from defusedxml.common import DefusedXmlException
from defusedxml.ElementTree import DefusedXMLParser

from navette.errors import FileFormatError
from navette.files.untrusted.budget import DOCUMENT, Budget, BudgetError, BudgetMeter

Node = TypeVar("Node")


class MakeNodes(Protocol[Node]):
    """Builds a tree of nodes of one's own class."""

    def node(self, tag: str, attributes: dict[str, str], line: int) -> Node:
        """Create an element; ``tag`` has no namespace."""

    def add(self, parent: Node, child: Node) -> None:
        """Append a child."""

    def text(self, node: Node, text: str) -> None:
        """Set the text of an element, at its end."""


class _Target(Generic[Node]):
    """Target of the parser."""

    def __init__(self, path: Path, make: MakeNodes[Node], budget: Budget) -> None:
        self.expat: object = None
        self._path = path
        self._make = make
        self._meter = BudgetMeter(budget)
        self._open: list[tuple[Node, list[str]]] = []
        self._root: Node | None = None

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self._spend(1 + len(attributes), depth=1)
        line = self._line()
        node = self._make.node(tag.rpartition("}")[2], dict(attributes), line)
        if self._open:
            self._make.add(self._open[-1][0], node)
        else:
            self._root = node
        self._open.append((node, []))

    def end(self, tag: str) -> None:
        node, texts = self._open.pop()
        self._meter.leave()
        # Joined once: text arrives line by line, and adding would be quadratic.
        self._make.text(node, "".join(texts))

    def data(self, text: str) -> None:
        if self._open:
            self._spend(1)
            self._open[-1][1].append(text)

    def close(self) -> Node | None:
        return self._root

    def _spend(self, items: int, depth: int = 0) -> None:
        try:
            self._meter.spend_items(items, "elements and attributes")
            if depth:
                self._meter.enter()
        except BudgetError as error:
            raise FileFormatError(self._path, str(error), self._line()) from None

    def _line(self) -> int:
        return int(getattr(self.expat, "CurrentLineNumber", 0))


def parse_xml(
    data: bytes, path: Path, make: MakeNodes[Node], budget: Budget = DOCUMENT
) -> Node:
    """Parse a text and return its root.

    Args:
        path: named in errors.

    Raises:
        FileFormatError: invalid XML, entities, document types, or beyond the budget;
            names the line.
    """
    target = _Target(path, make, budget)
    parser = DefusedXMLParser(target=target, forbid_dtd=True)
    target.expat = parser.parser
    try:
        budget.check_octets(len(data))
        parser.feed(data)
        root: Node | None = parser.close()
    except BudgetError as error:
        raise FileFormatError(path, str(error)) from None
    except ParseError as error:
        line = error.position[0]
        raise FileFormatError(path, f"not XML: {error.msg}", line) from None
    except DefusedXmlException as error:
        raise FileFormatError(path, f"XML refused: {type(error).__name__}") from None
    except (ValueError, LookupError) as error:
        if isinstance(error, FileFormatError):
            raise
        raise FileFormatError(path, f"not XML: {error}") from None  # an encoding
    if root is None:
        raise FileFormatError(path, "not XML: no element")
    return root
