"""Reader of YAML launch files: nested mappings become elements as in XML."""

from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError
from navette.ros2.packages.launch.frontend.element import Element

MAX_DEPTH = 64
MAX_ELEMENTS = 100_000
_CHILDREN = "children"


def read_yaml(text: bytes, path: Path) -> Element:
    """Return the root element (``launch``) of a file's text.

    Raises:
        FileFormatError: invalid YAML, or an invalid structure; names the line.
    """
    try:
        root = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = None if mark is None else mark.line + 1
        reason = getattr(error, "problem", None) or str(error)
        raise FileFormatError(path, f"not YAML: {reason}", line) from None
    except RecursionError:
        raise FileFormatError(path, f"nested deeper than {MAX_DEPTH}") from None
    if not isinstance(root, yaml.MappingNode) or len(root.value) != 1:
        raise FileFormatError(path, "expected one mapping, 'launch:', at the top")
    key, value = root.value[0]
    return _Reader(path).element(str(key.value), value, key.start_mark.line + 1, 0)


class _Reader:
    """Converts YAML nodes to elements."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._count = 0

    def element(self, tag: str, node: yaml.Node, line: int, depth: int) -> Element:
        """Convert ``tag: {attributes and lists}`` or ``tag: [children]``."""
        element = Element(tag, self._path, line)
        self._count += 1  # a few aliases can expand to very many elements
        if depth > MAX_DEPTH or self._count > MAX_ELEMENTS:
            raise element.error(
                f"nested deeper than {MAX_DEPTH}, or more than {MAX_ELEMENTS} elements"
            )
        if isinstance(node, yaml.SequenceNode):
            element.children = self._children(element, node, depth)
            return element
        if not isinstance(node, yaml.MappingNode):
            if node.value in ("", None):
                return element
            raise element.error(f"{node.value!r}; expected attributes or a list")
        for key, value in node.value:
            self._add(element, str(key.value), value, depth)
        return element

    def _add(self, element: Element, name: str, value: yaml.Node, depth: int) -> None:
        if name == _CHILDREN and isinstance(value, yaml.SequenceNode):
            element.children += self._children(element, value, depth)
        elif self._holds_mappings(value) or isinstance(value, yaml.MappingNode):
            is_list = isinstance(value, yaml.SequenceNode)
            for item in value.value if is_list else [value]:
                line = int(item.start_mark.line) + 1
                element.children.append(self.element(name, item, line, depth + 1))
        elif name in element.attributes:
            raise element.error(f"attribute {name!r} is given more than once")
        else:
            element.attributes[name] = self._scalar(element, name, value)

    def _children(
        self, element: Element, node: yaml.SequenceNode, depth: int
    ) -> list[Element]:
        found = []
        for item in node.value:
            if not isinstance(item, yaml.MappingNode) or len(item.value) != 1:
                raise FileFormatError(
                    self._path,
                    f"in <{element.tag}>: expected '- tag:' with one tag each",
                    int(item.start_mark.line) + 1,
                )
            key, value = item.value[0]
            line = int(key.start_mark.line) + 1
            found.append(self.element(str(key.value), value, line, depth + 1))
        return found

    @staticmethod
    def _holds_mappings(node: yaml.Node) -> bool:
        return (
            isinstance(node, yaml.SequenceNode)
            and bool(node.value)
            and all(isinstance(item, yaml.MappingNode) for item in node.value)
        )

    @staticmethod
    def _scalar(element: Element, name: str, node: yaml.Node) -> Any:
        """Return a scalar or a list of scalars, as ``yaml.safe_load`` does."""
        items = node.value if isinstance(node, yaml.SequenceNode) else [node]
        if not all(isinstance(item, yaml.ScalarNode) for item in items):
            raise element.error(f"attribute {name!r}: expected a value or a list")
        try:
            return yaml.safe_load(yaml.serialize(node, Dumper=yaml.SafeDumper))
        except yaml.YAMLError as error:
            reason = getattr(error, "problem", None) or str(error)
            raise element.error(f"attribute {name!r}: not YAML: {reason}") from None
