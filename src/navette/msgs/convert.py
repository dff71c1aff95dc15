"""Conversion of messages from and to plain dicts: JSON, YAML, the command line."""

from array import array
from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np

from navette.errors import MessageError
from navette.msgs.base import Message
from navette.msgs.classes import get_message_class
from navette.msgs.interface import Field
from navette.msgs.values import shortened

M = TypeVar("M", bound=Message)


def to_dict(msg: Message) -> dict[str, Any]:
    """Return nested dicts of fields; arrays become lists, a byte an integer."""
    return {name: _plain(getattr(msg, name)) for name in msg._field_types_}


def from_dict(cls: type[M], values: Mapping[str, Any]) -> M:
    """Make a message from the given fields; the others keep their defaults.

    Nested messages are dicts, which may be partial, or messages.

    Raises:
        MessageError: an unknown field (the error lists the fields) or a wrong value.
    """
    if not isinstance(values, Mapping) or not all(isinstance(k, str) for k in values):
        raise MessageError(
            f"{cls._type_name_}: {shortened(values)} is {type(values).__name__}, "
            "expected a dict of fields"
        )
    fields = {field.name: field for field in cls._spec_.fields}
    converted = {
        name: _convert(fields[name], value) if name in fields else value
        for name, value in values.items()
    }
    return cls(**converted)


def _plain(value: Any) -> Any:
    if isinstance(value, Message):
        return to_dict(value)
    if isinstance(value, (np.ndarray, array)):
        return value.tolist()
    if isinstance(value, list):
        return [_plain(item) for item in value]
    if isinstance(value, bytes):
        return value[0]
    return value


def _convert(field: Field, value: Any) -> Any:
    if not field.type.is_message:
        return value
    cls = get_message_class(field.type.base)
    if field.type.is_scalar:
        return _message(cls, value)
    if not isinstance(value, (list, tuple)):
        return value
    return [_message(cls, item) for item in value]


def _message(cls: type[Message], value: Any) -> Any:
    return from_dict(cls, value) if isinstance(value, Mapping) else value
