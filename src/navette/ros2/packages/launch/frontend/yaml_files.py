"""Reader of YAML launch files: nested mappings become elements as in XML."""

from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError
from navette.files.untrusted.yaml_input import (
    compose_yaml,
    line_of,
    load_yaml,
    problem_of,
)
from navette.ros2.packages.launch.frontend.element import Element

_CHILDREN = "children"


def read_yaml(text: bytes, path: Path) -> Element:
    """Return the root element (``launch``) of a file's text.

    Raises:
        FileFormatError: invalid YAML, or an invalid structure; names the line.
    """
    try:
        root = compose_yaml(text)
    except yaml.YAMLError as error:
        reason = f"not YAML: {problem_of(error)}"
        raise FileFormatError(path, reason, line_of(error)) from None
    if not isinstance(root, yaml.MappingNode) or len(root.value) != 1:
        raise FileFormatError(path, "expected one mapping, 'launch:', at the top")
    key, value = root.value[0]
    return _Reader(path).element(str(key.value), value, key.start_mark.line + 1)


class _Reader:
    """Converts YAML nodes to elements."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def element(self, tag: str, node: yaml.Node, line: int) -> Element:
        """Convert ``tag: {attributes and lists}`` or ``tag: [children]``."""
        element = Element(tag, self._path, line)
        if isinstance(node, yaml.SequenceNode):
            self._add_children(element, node)
            return element
        if not isinstance(node, yaml.MappingNode):
            if node.value in ("", None):
                return element
            raise element.error(f"{node.value!r}; expected attributes or a list")
        for key, value in node.value:
            self._add(element, str(key.value), value)
        return element

    def _add(self, element: Element, name: str, value: yaml.Node) -> None:
        if name == _CHILDREN and isinstance(value, yaml.SequenceNode):
            self._add_children(element, value)
        elif self._holds_mappings(value) or isinstance(value, yaml.MappingNode):
            is_list = isinstance(value, yaml.SequenceNode)
            for item in value.value if is_list else [value]:
                line = int(item.start_mark.line) + 1
                element.add(self.element(name, item, line))
        elif name in element.attributes:
            raise element.error(f"attribute {name!r} is given more than once")
        else:
            element.attributes[name] = self._scalar(element, name, value)

    def _add_children(self, element: Element, node: yaml.SequenceNode) -> None:
        for item in node.value:
            if not isinstance(item, yaml.MappingNode) or len(item.value) != 1:
                raise FileFormatError(
                    self._path,
                    f"in <{element.tag}>: expected '- tag:' with one tag each",
                    int(item.start_mark.line) + 1,
                )
            key, value = item.value[0]
            line = int(key.start_mark.line) + 1
            element.add(self.element(str(key.value), value, line))

    @staticmethod
    def _holds_mappings(node: yaml.Node) -> bool:
        return (
            isinstance(node, yaml.SequenceNode)
            and bool(node.value)
            and all(isinstance(item, yaml.MappingNode) for item in node.value)
        )

    @staticmethod
    def _scalar(element: Element, name: str, node: yaml.Node) -> Any:
        """Return a scalar or a list of scalars, as YAML reads it."""
        items = node.value if isinstance(node, yaml.SequenceNode) else [node]
        if not all(isinstance(item, yaml.ScalarNode) for item in items):
            raise element.error(f"attribute {name!r}: expected a value or a list")
        try:
            return load_yaml(yaml.serialize(node, Dumper=yaml.SafeDumper))
        except yaml.YAMLError as error:
            reason = f"not YAML: {problem_of(error)}"
            raise element.error(f"attribute {name!r}: {reason}") from None
