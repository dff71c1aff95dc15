"""rosidl_runtime_py.convert: messages as text in the form of ``ros2 topic echo``.

``truncate_length`` limits the number of items of arrays and texts, which then end in
``...``; ``no_arr`` and ``no_str`` replace arrays and texts by their type and length.
"""

from array import array
from collections import OrderedDict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from navette.msgs import Message
from navette.msgs.interface import FieldType
from navette.msgs.slot_types import IDL_NAMES, AbstractType
from navette.ros2.packages.rosidl_runtime_py.number_text import (
    CUT,
    Layout,
    Numbers,
    python_words,
)
from navette.ros2.packages.rosidl_runtime_py.yaml_text import yaml_text


@dataclass(frozen=True, slots=True)
class _Shortening:
    """Options to shorten a text."""

    length: int | None
    no_arr: bool
    no_str: bool


def message_to_yaml(
    msg: Message,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return the message as YAML, on one line with ``flow_style``."""
    fields = _fields(msg, _Shortening(truncate_length, no_arr, no_str))
    return "".join(yaml_text(fields, Layout(flow_style)))


def message_to_csv(
    msg: Message,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> str:
    """Return the message's values, separated by commas, in order of the fields."""
    return _csv(msg, _Shortening(truncate_length, no_arr, no_str))


def yaml_pieces(
    value: Any,
    field_type: FieldType | None,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
    width: int | None = None,
) -> Iterator[str]:
    """Return a message or one of its sequences as pieces of YAML.

    Args:
        width: number of characters per line for arrays of numbers; default: one number
            per line.

    Returns:
        Alternately text without arrays of numbers, and one such array.
    """
    shortening = _Shortening(truncate_length, no_arr, no_str)
    return yaml_text(_plain(value, shortening, field_type), Layout(flow_style, width))


def value_to_csv(
    value: Any,
    field_type: FieldType,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> str:
    """Return a field's value in the form of :func:`message_to_csv`."""
    return _csv(value, _Shortening(truncate_length, no_arr, no_str), field_type)


def message_to_ordereddict(
    msg: Message,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> "OrderedDict[str, Any]":
    """Return the message's fields by name, recursively; arrays are lists."""
    shortening = _Shortening(truncate_length, no_arr, no_str)
    ordered: OrderedDict[str, Any] = _ordered(_fields(msg, shortening))
    return ordered


def get_message_slot_types(msg: Message) -> "OrderedDict[str, AbstractType]":
    """Return the types of the fields by name, as ``rosidl_parser`` names them."""
    names = msg.get_fields_and_field_types()
    return OrderedDict(zip(names, msg.SLOT_TYPES, strict=True))


def _ordered(value: Any) -> Any:
    if isinstance(value, dict):
        return OrderedDict((name, _ordered(each)) for name, each in value.items())
    if isinstance(value, Numbers):
        return value.plain()
    if isinstance(value, list):
        return [_ordered(each) for each in value]
    return value


def _fields(msg: Message, shortening: _Shortening) -> dict[str, Any]:
    return {
        field.name: _plain(getattr(msg, field.name), shortening, field.type)
        for field in msg._spec_.fields
    }


def _plain(
    value: Any, shortening: _Shortening, field_type: FieldType | None = None
) -> Any:
    if isinstance(value, Message):
        return _fields(value, shortening)
    if isinstance(value, bytes):
        return _short(value.decode("latin-1"), shortening.length, CUT)
    if isinstance(value, str):
        if shortening.no_str:
            return _hidden_text(value)
        return _short(value, shortening.length, CUT)
    if isinstance(value, (list, array, np.ndarray)):
        if shortening.no_arr and field_type is not None:
            return _hidden_array(field_type, len(value))
        items = _short(value, shortening.length, None)
        if not isinstance(items, list) or _is_of_bools(field_type):
            return Numbers(items, is_cut=items is not value)
        plain = [_plain(item, shortening) for item in items]
        return plain if items is value else [*plain, CUT]
    return value


def _is_of_bools(field_type: FieldType | None) -> bool:
    return field_type is not None and field_type.base == "bool"


def _csv(
    value: Any, shortening: _Shortening, field_type: FieldType | None = None
) -> str:
    if isinstance(value, Message):
        types = {field.name: field.type for field in value._spec_.fields}
        return ",".join(
            _csv(getattr(value, name), shortening, t) for name, t in types.items()
        )
    if isinstance(value, (list, array, np.ndarray)):
        if shortening.no_arr and field_type is not None:
            return _hidden_array(field_type, len(value))
        items = _short(value, shortening.length, None)
        if isinstance(items, list):
            text = ",".join(_csv(item, shortening) for item in items)
        else:
            text = python_words(np.asarray(items), ",")
        end = () if items is value else (CUT,)
        return ",".join((text, *end) if len(items) else end)
    if isinstance(value, str):
        if shortening.no_str:
            return _hidden_text(value)
        return str(_short(value, shortening.length, CUT))
    return str(value)


def _short(value: Any, length: int | None, end: str | None) -> Any:
    """Return a short value unchanged, of a long one its start followed by ``end``."""
    if length is None or len(value) <= length:
        return value
    start = value[:length]
    return start if end is None else start + end


def _hidden_text(value: str) -> str:
    return f"<string length: <{len(value)}>>"


def _hidden_array(field_type: FieldType, length: int) -> str:
    base = IDL_NAMES.get(field_type.base, field_type.base)
    if field_type.container == "array":
        return f"<array type: {base}[{field_type.size}]>"
    bound = "" if field_type.size is None else f"[{field_type.size}]"
    return f"<sequence type: {base}{bound}, length: {length}>"
