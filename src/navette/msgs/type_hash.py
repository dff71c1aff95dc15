"""RIHS01 type hashes, by which ROS 2 programs compare their definitions of a type.

REP 2011 and rosidl's type description: SHA-256 of a fixed JSON form of the type and all
types that it refers to. Names of fields and types count; defaults and constants do not.
"""

import hashlib
import json
from typing import Any

from navette.msgs.interface import ActionSpec, Field, FieldType, MessageSpec, Spec
from navette.msgs.registry import get_spec

# Values of type_description_interfaces/msg/FieldType; arrays add to the scalar's value.
# ``char`` in a .msg file is an unsigned byte: its id is that of uint8, not 13 (CHAR).
_IDS = {
    "message": 1,
    "int8": 2,
    "uint8": 3,
    "char": 3,
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    "string": 17,
    "wstring": 18,
    "bounded string": 21,
    "bounded wstring": 22,
}
_ARRAY, _BOUNDED_SEQUENCE, _SEQUENCE = 48, 96, 144

Description = dict[str, Any]

# The definition of each type and its hash.
_hashes: dict[str, tuple[Spec, str]] = {}


def type_hash(name: str) -> str:
    """Return ``RIHS01_`` and 64 hex digits, as ROS 2 computes them."""
    spec = get_spec(name)
    known, found = _hashes.get(name, (None, ""))
    if known is not spec:
        text = json.dumps(type_description(name), ensure_ascii=False)
        found = "RIHS01_" + hashlib.sha256(text.encode()).hexdigest()
        _hashes[name] = spec, found
    return found


def type_description(name: str) -> Description:
    """Return the type and all types that it refers to, in the form that is hashed.

    Keys and their order are those of type_description_interfaces/msg/TypeDescription,
    without default values.
    """
    spec = get_spec(name)
    referenced: dict[str, Description] = {}
    for field in _fields_of(spec):
        _collect(field.type, referenced)
    return {
        "type_description": _describe(spec),
        "referenced_type_descriptions": [referenced[key] for key in sorted(referenced)],
    }


def _collect(type_: FieldType, referenced: dict[str, Description]) -> None:
    if not type_.is_message or type_.base in referenced:
        return
    spec = get_spec(type_.base)
    referenced[type_.base] = _describe(spec)
    for field in _fields_of(spec):
        _collect(field.type, referenced)


def _describe(spec: Spec) -> Description:
    fields = [_describe_field(field) for field in _fields_of(spec)]
    return {"type_name": spec.name, "fields": fields}


def _fields_of(spec: Spec) -> tuple[Field, ...]:
    if isinstance(spec, MessageSpec):
        return spec.wire_fields
    if isinstance(spec, ActionSpec):
        parts = {
            "goal": spec.goal.name,
            "result": spec.result.name,
            "feedback": spec.feedback.name,
            "send_goal_service": spec.send_goal.name,
            "get_result_service": spec.get_result.name,
            "feedback_message": spec.feedback_message.name,
        }
    else:
        parts = {
            "request_message": spec.request.name,
            "response_message": spec.response.name,
            "event_message": spec.event.name,
        }
    return tuple(Field(name, FieldType(base)) for name, base in parts.items())


def _describe_field(field: Field) -> Description:
    type_ = field.type
    capacity = type_.size or 0
    return {
        "name": field.name,
        "type": {
            "type_id": _type_id(type_),
            "capacity": capacity,
            "string_capacity": type_.string_bound or 0,
            "nested_type_name": type_.base if type_.is_message else "",
        },
    }


def _type_id(type_: FieldType) -> int:
    base = "message" if type_.is_message else type_.base
    if type_.string_bound is not None:
        base = f"bounded {base}"
    if type_.is_scalar:
        return _IDS[base]
    if type_.container == "array":
        return _IDS[base] + _ARRAY
    return _IDS[base] + (_SEQUENCE if type_.size is None else _BOUNDED_SEQUENCE)
