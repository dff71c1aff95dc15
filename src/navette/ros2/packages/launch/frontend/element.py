"""Elements of XML and YAML launch files, with their line."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, get_args

from navette.errors import FileFormatError
from navette.ros2.packages.launch.frontend.attribute_types import converted
from navette.ros2.packages.launch.frontend.grammar import parse_substitution
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch.typed import FALSE, TRUE
from navette.ros2.packages.launch.utilities.type_utils import coerce_to_type


@dataclass(eq=False)
class Element:
    """A tag with attributes and child elements.

    The methods record what was read; :meth:`finish` raises for the rest, so that a
    mistyped attribute is an error.

    Args:
        tag: such as ``node``.
        path, line: where it is written.
        attributes: text; from YAML also numbers, truths and lists of these.
        children: elements inside, in order.
    """

    tag: str
    path: Path
    line: int
    attributes: dict[str, Any] = field(default_factory=dict)
    children: list["Element"] = field(default_factory=list)
    parent: "Element | None" = None
    _seen: set[str] = field(default_factory=set)
    _all_seen: bool = False

    def add(self, child: "Element") -> None:
        """Append a child."""
        child.parent = self
        self.children.append(child)

    @property
    def origin(self) -> str:
        return f"{self.path}:{self.line}"

    def error(self, reason: str) -> FileFormatError:
        """Create an error about this element, with file and line."""
        return FileFormatError(self.path, f"<{self.tag}>: {reason}", self.line)

    def value(self, name: str) -> Any:
        """Return an attribute as written, or None."""
        self._seen.add(name)
        return self.attributes.get(name)

    def text(self, name: str) -> str | None:
        """Return an attribute as text, or None."""
        value = self.value(name)
        if isinstance(value, bool):
            return str(value).lower()
        if value is None or isinstance(value, (str, int, float)):
            return None if value is None else str(value)
        raise self.error(f"attribute {name!r}: {value!r}; expected text")

    def need(self, name: str) -> str:
        """Return a required attribute."""
        text = self.text(name)
        if text is None:
            raise self.error(f"attribute {name!r} is missing")
        return text

    def parts(self, name: str) -> Parts | None:
        """Return an attribute with substitutions, or None."""
        text = self.text(name)
        return None if text is None else self.parse(text)

    def need_parts(self, name: str) -> Parts:
        """Return a required attribute with substitutions."""
        return self.parse(self.need(name))

    def parse(self, text: str) -> Parts:
        """Parse text that may contain ``$(…)``."""
        try:
            return parse_substitution(text)
        except ValueError as error:
            raise self.error(str(error)) from None

    def bool_or_parts(self, name: str) -> bool | Parts | None:
        """Return a truth value, or substitutions that give one, or None."""
        text = self.text(name)
        if text is None or "$(" in text:
            return self.parts(name)
        try:
            return bool(coerce_to_type(text.lower(), bool))
        except ValueError as error:
            raise self.error(f"attribute {name!r}: {error}") from None

    def number_or_parts(self, name: str) -> float | Parts:
        """Return a required number, or substitutions that give one."""
        text = self.need(name)
        if "$(" in text:
            return self.parse(text)
        try:
            return float(text)
        except ValueError:
            raise self.error(
                f"attribute {name!r}: {text!r}; expected a number"
            ) from None

    def flag(self, name: str) -> bool | None:
        """Return a constant boolean attribute, or None."""
        text = self.text(name)
        if text is None:
            return None
        if text.lower() not in TRUE + FALSE:
            raise self.error(f"attribute {name!r}: {text!r}; expected true or false")
        return text.lower() in TRUE

    def elements(self, tag: str) -> list["Element"]:
        """Return the children with this tag."""
        self._seen.add(f"<{tag}>")
        return [child for child in self.children if child.tag == tag]

    def rest(self) -> list["Element"]:
        """Return the children not read by tag so far."""
        self._all_seen = True
        return [c for c in self.children if f"<{c.tag}>" not in self._seen]

    @property
    def type_name(self) -> str:
        """ROS 2's name of the tag."""
        return self.tag

    def get_attr(
        self,
        name: str,
        *,
        data_type: Any = str,
        optional: bool = False,
        can_be_str: bool = True,
    ) -> Any:
        """Return an attribute, as extensions that are written for ROS 2 read it.

        Args:
            data_type: see :func:`converted`; ``list[Entity]`` returns the children of
                that tag. In XML, ``NAME-sep`` holds the separator of a list's items.
            optional: return None where the attribute is missing.
            can_be_str: text with substitutions is accepted for any type.

        Raises:
            AttributeError: the attribute is missing.
            TypeError: it has another type.
        """
        if get_args(data_type) == (Element,):
            value: Any = self.elements(name) or None
        else:
            value = self.value(name)
            separator = self.value(f"{name}-sep")
            if value is not None and separator is not None:
                value = str(value).split(str(separator))
        if value is None:
            if optional:
                return None
            raise AttributeError(
                f"Attribute {name!r} of type {data_type} not found in {self.tag!r}"
            )
        if get_args(data_type) == (Element,):
            return value
        try:
            return converted(value, data_type, can_be_str=can_be_str)
        except TypeError as error:
            raise TypeError(f"Attribute {name!r} of {self.tag!r}: {error}") from None

    def assert_entity_completely_parsed(self) -> None:
        """Raise ValueError for attributes and children that were not read."""
        try:
            self.finish()
        except FileFormatError as error:
            raise ValueError(str(error)) from error

    def finish(self) -> None:
        """Raise for attributes and children that were not read."""
        unread = [name for name in self.attributes if name not in self._seen]
        known = sorted(name for name in self._seen if name[0] != "<")
        if unread:
            raise self.error(
                f"unknown attribute {unread[0]!r} of `{self.tag}`; known: "
                f"{', '.join(known)}"
            )
        for child in self.children:
            if not self._all_seen and f"<{child.tag}>" not in self._seen:
                inside = sorted(name for name in self._seen if name[0] == "<")
                raise child.error(
                    f"not allowed in `{self.tag}`; allowed: "
                    f"{', '.join(inside) or 'nothing'}"
                )
