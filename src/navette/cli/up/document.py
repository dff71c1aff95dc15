"""YAML document with the line number of each value."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError
from navette.files.untrusted.budget import DOCUMENT
from navette.files.untrusted.files import read_bounded
from navette.files.untrusted.yaml_input import line_of, problem_of
from navette.runtime.parameter_files import RosLoader

# Keys and list indices that lead to a value: ("services", "robot", "nodes", 0).
Place = tuple[str | int, ...]


@dataclass(frozen=True)
class Document:
    """Content of a YAML file whose root is a mapping.

    Attributes:
        lines: place → line of the key or list item, from 1.
    """

    path: Path
    content: Mapping[str, Any]
    lines: Mapping[Place, int]

    def error(self, reason: str, *place: str | int) -> FileFormatError:
        """Return an error with the line of ``place`` or of its nearest parent."""
        while place and place not in self.lines:
            place = place[:-1]
        return FileFormatError(self.path, reason, self.lines.get(place))


def read_document(path: Path, expected: str) -> Document:
    """Read a YAML file.

    Args:
        expected: error text for a root that is not a mapping.

    Raises:
        FileFormatError: too large, not YAML, not a mapping, a duplicate key, or an
            alias (a few aliases can expand to very large documents).
    """
    data = read_bounded(path, DOCUMENT)
    loader = None
    try:
        loader = RosLoader(data)
        _refuse_aliases(path, data)
        root = loader.get_single_node()
        lines = {} if root is None else dict(_lines(path, root, ()))
        content = None if root is None else loader.construct_document(root)
    except yaml.YAMLError as error:
        reason = f"not YAML: {problem_of(error)}"
        raise FileFormatError(path, reason, line_of(error)) from None
    finally:
        if loader is not None:
            loader.dispose()
    if not isinstance(content, dict):
        raise FileFormatError(path, expected)
    return Document(path, content, lines)


def _refuse_aliases(path: Path, data: bytes) -> None:
    loader: Any = RosLoader
    for event in yaml.parse(data, Loader=loader):
        if isinstance(event, yaml.AliasEvent):
            reason = f"YAML alias *{event.anchor}: aliases are not supported"
            raise FileFormatError(path, reason, _line(event))


def _lines(path: Path, node: Any, place: Place) -> Iterator[tuple[Place, int]]:
    """Yield the place and line of everything in a node."""
    if isinstance(node, yaml.SequenceNode):
        for number, item in enumerate(node.value):
            yield (*place, number), _line(item)
            yield from _lines(path, item, (*place, number))
    elif isinstance(node, yaml.MappingNode):
        seen: dict[str, int] = {}
        for key, value in node.value:
            name, line = str(key.value), _line(key)
            if name in seen:
                reason = f"duplicate key {name!r}, first in line {seen[name]}"
                raise FileFormatError(path, reason, line)
            seen[name] = line
            yield (*place, name), line
            yield from _lines(path, value, (*place, name))


def _line(part: Any) -> int:
    return int(part.start_mark.line) + 1
