"""``pose.position.x``, ``ranges[0]``, ``poses[-1].pose``: a part of a message."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from navette.errors import MessageError
from navette.msgs.interface import Field, FieldType
from navette.msgs.registry import get_message_spec

_STEP = re.compile(r"\.?(?P<name>[A-Za-z]\w*)|\[(?P<index>-?\d{1,9}|-?\d*:-?\d*)\]")
_LONGEST = 1000

Step = str | int | slice


@dataclass(frozen=True)
class FieldPath:
    """Steps from a message to a part of it, and the type of that part."""

    text: str
    steps: tuple[Step, ...]
    type: FieldType

    def of(self, message: Any) -> Any:
        """The part.

        Raises:
            IndexError: a sequence is too short in this message.
        """
        for step in self.steps:
            message = getattr(message, step) if isinstance(step, str) else message[step]
        return message


def parse_field_path(text: str, type_name: str) -> FieldPath:
    """Read a path and check it against the message's definition.

    Raises:
        MessageError: the path has the wrong form, or leads nowhere; says where.
    """
    found = FieldType(type_name)
    steps: list[Step] = []
    position = 0
    text = text.strip()
    while position < len(text) <= _LONGEST:
        match = _STEP.match(text, position)
        if match is None:
            break
        step, found = _step(match, found, text[: match.end()])
        steps.append(step)
        position = match.end()
    if not steps or position < len(text):
        raise MessageError(
            f"field {text[:60]!r}: wanted a path such as pose.position.x or ranges[0]"
        )
    return FieldPath(text, tuple(steps), found)


def field_paths(begun: str, type_name: str) -> Iterator[str]:
    """Paths that go on from one that somebody has begun to type, two names deep.

    Raises:
        MessageError: what stands before its last dot leads nowhere.
    """
    before = begun.rpartition(".")[0]
    owner = parse_field_path(before, type_name).type if before else FieldType(type_name)
    for field in _fields(owner):
        path = f"{before}.{field.name}" if before else field.name
        yield path
        for below in _fields(field.type):
            yield f"{path}.{below.name}"


def _fields(owner: FieldType) -> tuple[Field, ...]:
    """Those of a message; of many messages none."""
    is_one = owner.is_message and owner.is_scalar
    return get_message_spec(owner.base).fields if is_one else ()


def _step(
    match: re.Match[str], owner: FieldType, so_far: str
) -> tuple[Step, FieldType]:
    if match["name"] is not None:
        return match["name"], _field(match["name"], owner, so_far)
    if owner.is_scalar:
        raise MessageError(f"field {so_far!r}: {owner} has no elements")
    first, colon, last = match["index"].partition(":")
    if colon:
        ends = [int(end) if end.strip("-") else None for end in (first, last)]
        return slice(*ends), replace(owner, container="sequence", size=None)
    return int(first), replace(owner, container="scalar", size=None)


def _field(name: str, owner: FieldType, so_far: str) -> FieldType:
    if not owner.is_scalar:
        raise MessageError(
            f"field {so_far!r}: {owner} is many; take one, as in [0], before .{name}"
        )
    if not owner.is_message:
        raise MessageError(f"field {so_far!r}: {owner} has no fields")
    fields = get_message_spec(owner.base).fields
    for field in fields:
        if field.name == name:
            return field.type
    known = ", ".join(field.name for field in fields) or "none"
    raise MessageError(f"field {so_far!r}: {owner} has no such field; it has {known}")
