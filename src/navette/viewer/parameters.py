"""Convert ROS 2 parameter values to and from the Foxglove protocol."""

import base64
import binascii
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from navette.errors import ParameterError
from navette.viewer.frames import WireParameter


def wire_name(node: str, parameter: str) -> str:
    """``/planner`` and ``method`` → ``/planner.method``, as in foxglove_bridge."""
    return f"{node}.{parameter}"


def split_name(name: str) -> tuple[str, str]:
    """``/planner.method`` (or ``planner.method``) → (``/planner``, ``method``)."""
    node, dot, parameter = name.partition(".")
    if not (node and dot and parameter):
        raise ParameterError(
            f"parameter {name!r:.120}: the name must be /node.parameter"
        )
    return node if node.startswith("/") else f"/{node}", parameter


def to_wire(name: str, value: Any) -> WireParameter:
    """Convert a value for JSON; ``kind`` marks doubles and bytes.

    JSON has neither NaN nor infinity: such a number is sent as unset.
    """
    if isinstance(value, bytes | bytearray):
        return WireParameter(name, base64.b64encode(value).decode(), "byte_array")
    if isinstance(value, float):
        return WireParameter(name, value if math.isfinite(value) else None, "float64")
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, bool | int | str) or value is None:
        return WireParameter(name, value)
    return _array_to_wire(name, list(value))


def _array_to_wire(name: str, items: list[Any]) -> WireParameter:
    if items and all(isinstance(item, bytes) and len(item) == 1 for item in items):
        return to_wire(name, b"".join(items))
    if items and all(isinstance(item, float) for item in items):
        finite = [item if math.isfinite(item) else None for item in items]
        return WireParameter(name, finite, "float64_array")
    return WireParameter(name, items)


def from_wire(parameter: WireParameter, current: Any) -> Any:
    """Return the value to set; numbers take the type of ``current`` (3 → 3.0).

    Raises:
        ParameterError: the value contradicts its ``kind`` or has no ROS 2 type.
    """
    value, kind = parameter.value, parameter.kind
    if kind == "byte_array":
        return _bytes_of(parameter)
    if isinstance(value, dict):
        raise ParameterError(
            f"parameter {parameter.name!r}: a JSON object is not a ROS 2 parameter type"
        )
    if kind == "float64" or (_is_number(value) and isinstance(current, float)):
        return _float(parameter, value)
    if isinstance(value, list):
        floats = kind == "float64_array" or _holds_floats(current)
        mixed = any(isinstance(item, float) for item in value)
        if floats or (mixed and all(map(_is_number, value))):
            return [_float(parameter, item) for item in value]
    if isinstance(value, float) and isinstance(current, int) and value.is_integer():
        # JavaScript does not distinguish integers.
        return int(value)
    return value


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _holds_floats(value: object) -> bool:
    if isinstance(value, str | bytes) or not isinstance(value, Iterable):
        return False
    items = list(value)
    return bool(items) and all(isinstance(item, float) for item in items)


def _float(parameter: WireParameter, value: object) -> float:
    if not isinstance(value, int | float) or isinstance(value, bool):
        raise ParameterError(
            f"parameter {parameter.name!r}: {value!r:.80} is not a number"
        )
    return float(value)


def _bytes_of(parameter: WireParameter) -> list[bytes]:
    try:
        data = base64.b64decode(parameter.value, validate=True)
    except (binascii.Error, TypeError, ValueError):
        raise ParameterError(f"parameter {parameter.name!r}: is not base64") from None
    return [bytes([byte]) for byte in data]


_FIELDS = {
    1: "bool_value",
    2: "integer_value",
    3: "double_value",
    4: "string_value",
    5: "byte_array_value",
    6: "bool_array_value",
    7: "integer_array_value",
    8: "double_array_value",
    9: "string_array_value",
}


def value_of(message: Any) -> Any:
    """Return the value of an rcl_interfaces/msg/ParameterValue.

    None if it is unset or its rcl_interfaces/msg/ParameterType is unknown.
    """
    name = _FIELDS.get(message.type)
    value = None if name is None else getattr(message, name)
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value


_LONGEST_TEXT = 500


@dataclass(frozen=True)
class ParameterText:
    """Description of a parameter, as its node declares it.

    Args:
        name: as returned by :func:`wire_name`.
        meaning: one line of text.
        allowed: additional constraints, as text.
        low, high: ends of the range, None without one.
        step: step of the range; 0 allows any value in it.
    """

    name: str
    meaning: str = ""
    allowed: str = ""
    read_only: bool = False
    low: float | None = None
    high: float | None = None
    step: float = 0.0

    @classmethod
    def of(cls, name: str, descriptor: Any) -> "ParameterText":
        """Convert an rcl_interfaces/msg/ParameterDescriptor; invalid ranges are
        omitted."""
        low = high = None
        step = 0.0
        for bounds in (*descriptor.floating_point_range, *descriptor.integer_range):
            ends = float(bounds.from_value), float(bounds.to_value)
            # JSON has no infinity.
            if all(map(math.isfinite, ends)) and ends[0] < ends[1]:
                low, high = ends
                width = float(bounds.step)
                step = width if 0.0 < width <= high - low else 0.0
        return cls(
            name,
            descriptor.description[:_LONGEST_TEXT],
            descriptor.additional_constraints[:_LONGEST_TEXT],
            bool(descriptor.read_only),
            low,
            high,
            step,
        )
