# SPDX-License-Identifier: Apache-2.0
"""Safe parsing of robot and world XML, with the line of every element.

World files are untrusted: see :mod:`navette.files.untrusted`.
"""

import logging
import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from navette.errors import FileFormatError
from navette.files.untrusted import xml_input
from navette.files.untrusted.budget import SCENE
from navette.files.untrusted.files import read_bounded

_log = logging.getLogger(__name__)


@dataclass(eq=False, slots=True)
class XmlNode:
    """An element: tag, attributes, text, children and the line it starts on."""

    tag: str
    attributes: dict[str, str]
    line: int
    path: Path
    text: str = ""
    children: list["XmlNode"] = field(default_factory=list)

    def error(self, reason: str) -> FileFormatError:
        return FileFormatError(self.path, f"<{self.tag}>: {reason}", self.line)

    def all(self, tag: str) -> Iterator["XmlNode"]:
        return (child for child in self.children if child.tag == tag)

    def find(self, *tags: str) -> "XmlNode | None":
        """Return the first descendant along the path of tags, or None."""
        node: XmlNode | None = self
        for tag in tags:
            node = next(node.all(tag), None) if node is not None else None
        return node

    def need(self, tag: str) -> "XmlNode":
        child = self.find(tag)
        if child is None:
            raise self.error(f"<{tag}> is missing")
        return child

    def name(self) -> str:
        return self.need_attribute("name")

    def need_attribute(self, key: str) -> str:
        value = self.attributes.get(key, "").strip()
        if not value:
            raise self.error(f"attribute {key!r} is missing")
        return value

    def words(self, tag: str) -> str:
        """Text of a child; empty if it is missing."""
        child = self.find(tag)
        return child.text.strip() if child is not None else ""

    def flag(self, tag: str, *, default: bool = False) -> bool:
        text = self.words(tag).lower()
        if text in ("", "1", "true", "0", "false"):
            return text in ("1", "true") if text else default
        raise self.need(tag).error(f"{text!r} is not true or false")

    def number(self, tag: str, default: float | None = None) -> float:
        """A finite number from a child; required without a default."""
        child = self.find(tag) if default is not None else self.need(tag)
        if child is None or not child.text.strip():
            if default is None:
                raise self.error(f"<{tag}> is empty; expected a number")
            return default
        return child.numbers(1)[0]

    def positive(self, tag: str, default: float | None = None) -> float:
        value = self.number(tag, default)
        if value <= 0:
            raise self.error(f"<{tag}> is {value:g}; must be > 0")
        return value

    def numbers(self, count: int) -> tuple[float, ...]:
        """Exactly ``count`` finite numbers from this element's text."""
        return self.parse_numbers(self.text, count)

    def parse_numbers(self, text: str, count: int) -> tuple[float, ...]:
        try:
            values = tuple(float(word) for word in text.split())
        except ValueError:
            raise self.error(f"{text.strip()!r} are not numbers") from None
        if len(values) != count:
            raise self.error(f"{len(values)} numbers; expected {count}")
        if not all(map(math.isfinite, values)):
            raise self.error(f"{text.strip()!r}: expected finite numbers")
        return values


class Unsupported:
    """Collects what a reader cannot follow; logs each kind once after reading."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._count: Counter[str] = Counter()
        self._line: dict[str, int] = {}

    def note(self, kind: str, node: XmlNode) -> None:
        """Note an element that is ignored."""
        self.note_change(f"not supported, ignored: {kind}", node)

    def note_change(self, text: str, node: XmlNode) -> None:
        """Note an element that is read as another."""
        self._count[text] += 1
        self._line.setdefault(text, node.line)

    def report(self) -> None:
        for text, count in self._count.items():
            more = f" (and {count - 1} more)" if count > 1 else ""
            _log.warning("%s:%d: %s%s", self._path, self._line[text], text, more)


@dataclass(frozen=True)
class _Nodes:
    """Creates the nodes of a file."""

    path: Path

    def node(self, tag: str, attributes: dict[str, str], line: int) -> XmlNode:
        return XmlNode(tag, attributes, line, self.path)

    def add(self, parent: XmlNode, child: XmlNode) -> None:
        parent.children.append(child)

    def text(self, node: XmlNode, text: str) -> None:
        node.text = text


def parse_xml(path: Path) -> XmlNode:
    """Parse a file into nodes with lines.

    Raises:
        FileFormatError: invalid XML, entities, document types, or too large.
    """
    return xml_input.parse_xml(read_bounded(path, SCENE), path, _Nodes(path), SCENE)
