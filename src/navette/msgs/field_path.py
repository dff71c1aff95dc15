"""Paths to parts of messages: ``pose.position.x``, ``ranges[0]``, ``poses[-1]``."""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter, itemgetter
from typing import Any

from navette.errors import MessageError
from navette.msgs.interface import Field, FieldType
from navette.msgs.registry import get_message_spec

_STEP = re.compile(r"\.?(?P<name>[A-Za-z]\w*)|\[(?P<index>-?\d{1,9}|-?\d*:-?\d*)\]")
_MAX_LENGTH = 1000

Step = str | int | slice


@dataclass(frozen=True)
class FieldPath:
    """Steps from a message to a part of it, and the type of that part."""

    text: str
    steps: tuple[Step, ...]
    type: FieldType

    @cached_property
    def of(self) -> Callable[[Any], Any]:
        """Function from a message to the part.

        It raises IndexError for a message whose sequence is too short.
        """
        getters: list[Callable[[Any], Any]] = [
            attrgetter(step) if isinstance(step, str) else itemgetter(step)
            for step in self.steps
        ]
        if all(isinstance(step, str) for step in self.steps):
            return attrgetter(".".join(map(str, self.steps)))

        def part(message: Any) -> Any:
            for get in getters:
                message = get(message)
            return message

        return part


def parse_field_path(text: str, type_name: str) -> FieldPath:
    """Parse a path and check it against the definition of the message.

    Raises:
        MessageError: the path is malformed, or a field or element is unknown.
    """
    found = FieldType(type_name)
    steps: list[Step] = []
    position = 0
    text = text.strip()
    while position < len(text) <= _MAX_LENGTH:
        match = _STEP.match(text, position)
        if match is None:
            break
        step, found = _step(match, found, text[: match.end()])
        steps.append(step)
        position = match.end()
    if not steps or position < len(text):
        raise MessageError(
            f"field {text[:60]!r} is not a path such as pose.position.x or ranges[0]"
        )
    return FieldPath(text, tuple(steps), found)


def field_paths(prefix: str, type_name: str) -> Iterator[str]:
    """Complete a path: fields of the message at its last dot, and their fields.

    Raises:
        MessageError: the path before its last dot is wrong.
    """
    before = prefix.rpartition(".")[0]
    owner = parse_field_path(before, type_name).type if before else FieldType(type_name)
    for field in _fields(owner):
        path = f"{before}.{field.name}" if before else field.name
        yield path
        for below in _fields(field.type):
            yield f"{path}.{below.name}"


def _fields(owner: FieldType) -> tuple[Field, ...]:
    """Fields of a message; none for other types and for sequences."""
    is_one = owner.is_message and owner.is_scalar
    return get_message_spec(owner.base).fields if is_one else ()


def _step(
    match: re.Match[str], owner: FieldType, so_far: str
) -> tuple[Step, FieldType]:
    if match["name"] is not None:
        return match["name"], _field(match["name"], owner, so_far)
    if owner.is_scalar:
        raise MessageError(f"field {so_far!r}: {owner} is not an array")
    first, colon, last = match["index"].partition(":")
    if colon:
        ends = [int(end) if end.strip("-") else None for end in (first, last)]
        return slice(*ends), replace(owner, container="sequence", size=None)
    return int(first), replace(owner, container="scalar", size=None)


def _field(name: str, owner: FieldType, so_far: str) -> FieldType:
    if not owner.is_scalar:
        raise MessageError(
            f"field {so_far!r}: {owner} is an array; add an index, as in [0], "
            f"before .{name}"
        )
    if not owner.is_message:
        raise MessageError(f"field {so_far!r}: {owner} has no fields")
    fields = get_message_spec(owner.base).fields
    for field in fields:
        if field.name == name:
            return field.type
    known = ", ".join(field.name for field in fields) or "none"
    raise MessageError(f"field {so_far!r}: {owner} has no such field; known: {known}")
