"""Random messages of any type, for round-trip tests."""

from typing import Any, TypeVar

import numpy as np

from navette.msgs import Message, fields, get_interface
from navette.msgs.interface import FLOATS, INTEGER_RANGES, FieldType

M = TypeVar("M", bound=Message)

_CHARACTERS = ("a", "B", "7", " ", "/", "é", "地", "😀")
_MOST_ELEMENTS = 3


def random_message(cls: type[M], rng: np.random.Generator) -> M:
    """Return a message with random fields, the limits of their ranges included.

    Floats are finite and float32 fields have float32 values, so that the message equals
    its copy, also after serialization.
    """
    return cls(**{each.name: _value(each.type, rng) for each in fields(cls)})


def _value(type_: FieldType, rng: np.random.Generator) -> Any:
    if type_.is_scalar:
        return _scalar(type_, rng)
    if type_.container == "array":
        count = type_.size or 0
    else:
        most = _MOST_ELEMENTS if type_.size is None else min(_MOST_ELEMENTS, type_.size)
        count = int(rng.integers(0, most + 1))
    return [_scalar(type_, rng) for _ in range(count)]


def _scalar(type_: FieldType, rng: np.random.Generator) -> Any:
    if type_.is_message:
        return random_message(get_interface(type_.base), rng)
    if type_.is_string:
        most = 6 if type_.string_bound is None else min(6, type_.string_bound)
        length = int(rng.integers(0, most + 1))
        return "".join(rng.choice(_CHARACTERS, length))
    if type_.base in INTEGER_RANGES:
        low, high = INTEGER_RANGES[type_.base]
        drawn = low + int.from_bytes(rng.bytes(8), "little") % (high - low + 1)
        return (low, high, drawn)[int(rng.integers(3))]
    if type_.base in FLOATS:
        number = rng.normal() * 10.0 ** rng.integers(-30, 30)
        return float(np.float32(number)) if type_.base == "float32" else float(number)
    if type_.base == "bool":
        return bool(rng.integers(2))
    return bytes([int(rng.integers(256))])
