"""``navette.yaml`` as it was written: its values, and the line of each of them."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError
from navette.runtime.parameter_files import RosLoader

# Keys and positions on the way to a value: ("modules", "robot", "nodes", 0).
Place = tuple[str | int, ...]

_MOST_BYTES = 1 << 20


@dataclass(frozen=True)
class Document:
    """The content of a YAML file, a mapping.

    Attributes:
        lines: place → its line, from 1: of a key, or of an item of a list.
    """

    path: Path
    content: Mapping[str, Any]
    lines: Mapping[Place, int]

    def error(self, reason: str, *place: str | int) -> FileFormatError:
        """What is wrong, with the line of the place, or of the nearest around it."""
        while place and place not in self.lines:
            place = place[:-1]
        return FileFormatError(self.path, reason, self.lines.get(place))


def read_document(path: Path, wanted: str) -> Document:
    """Read a file.

    Args:
        wanted: what to say of one that is no mapping.

    Raises:
        FileFormatError: too large, not YAML, no mapping, a key that is there twice, or
            an alias (a few of them make very much of a little).
    """
    data = path.read_bytes()
    if len(data) > _MOST_BYTES:
        raise FileFormatError(path, f"larger than {_MOST_BYTES} bytes")
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
        raise FileFormatError(path, wanted)
    return Document(path, content, lines)


def _refuse_aliases(path: Path, data: bytes) -> None:
    for event in yaml.parse(data, Loader=RosLoader):
        if isinstance(event, yaml.AliasEvent):
            raise FileFormatError(
                path, f"YAML alias *{event.anchor}: not read here", _line(event)
            )


def _lines(path: Path, node: Any, place: Place) -> Iterator[tuple[Place, int]]:
    """The place and line of all that is in a node."""
    if isinstance(node, yaml.SequenceNode):
        for number, item in enumerate(node.value):
            yield (*place, number), _line(item)
            yield from _lines(path, item, (*place, number))
    elif isinstance(node, yaml.MappingNode):
        seen: dict[str, int] = {}
        for key, value in node.value:
            name, line = str(key.value), _line(key)
            if name in seen:
                raise FileFormatError(
                    path, f"{name!r} is there twice, first in line {seen[name]}", line
                )
            seen[name] = line
            yield (*place, name), line
            yield from _lines(path, value, (*place, name))


def _line(part: Any) -> int:
    """Where a part of the file begins, from 1."""
    return int(part.start_mark.line) + 1
