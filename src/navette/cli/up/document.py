"""YAML document with the line number of each value."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError
from navette.runtime.parameter_files import RosLoader

# Keys and list indices that lead to a value: ("services", "robot", "nodes", 0).
Place = tuple[str | int, ...]

_MAX_BYTES = 1 << 20


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
    data = path.read_bytes()
    if len(data) > _MAX_BYTES:
        raise FileFormatError(path, f"larger than {_MAX_BYTES} bytes")
    loader = RosLoader(data)
    try:
        _refuse_aliases(path, data)
        root = loader.get_single_node()
        lines = {} if root is None else dict(_lines(path, root, ()))
        content = None if root is None else loader.construct_document(root)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        reason = getattr(error, "problem", None) or str(error)
        line = None if mark is None else mark.line + 1
        raise FileFormatError(path, f"not YAML: {reason}", line) from None
    except RecursionError:
        raise FileFormatError(path, "nested too deep") from None
    finally:
        loader.dispose()
    if not isinstance(content, dict):
        raise FileFormatError(path, expected)
    return Document(path, content, lines)


def _refuse_aliases(path: Path, data: bytes) -> None:
    for event in yaml.parse(data, Loader=RosLoader):
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
