"""Parameters: names with values of ROS 2's parameter types."""

import math
from collections.abc import Sequence
from enum import IntEnum
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from navette.errors import ParameterError
from navette.msgs.rcl_interfaces.msg import Parameter as ParameterMsg
from navette.msgs.rcl_interfaces.msg import ParameterValue
from navette.runtime.exceptions import InvalidParameterException
from navette.runtime.strict_mode import is_strict

T = TypeVar("T")

AllowableParameterValue = (
    None
    | bool
    | int
    | float
    | str
    | Sequence[bytes]
    | Sequence[bool]
    | Sequence[int]
    | Sequence[float]
    | Sequence[str]
)
"""For annotations: the type of a parameter's value."""

PARAMETER_SEPARATOR_STRING = "."


def validate_parameter_name(name: str) -> bool:
    """Return True; raise InvalidParameterException if the name is empty."""
    if not isinstance(name, str) or not name:
        raise InvalidParameterException(str(name))
    return True


class ParameterType(IntEnum):
    """Types of values, with the numbers of rcl_interfaces/msg/ParameterType."""

    NOT_SET = 0
    BOOL = 1
    INTEGER = 2
    DOUBLE = 3
    STRING = 4
    BYTE_ARRAY = 5
    BOOL_ARRAY = 6
    INTEGER_ARRAY = 7
    DOUBLE_ARRAY = 8
    STRING_ARRAY = 9

    @classmethod
    def from_parameter_value(cls, parameter_value: Any) -> "ParameterType":
        """Return the type for a Python value; raise TypeError if there is none."""
        if parameter_value is None:
            return cls.NOT_SET
        for kind, python_type in _SCALARS.items():
            if isinstance(parameter_value, python_type):
                return kind
        if _is_array(parameter_value):
            items = list(parameter_value)
            for kind, item_type in _ITEMS.items():
                if all(_is_item(item, item_type) for item in items):
                    return kind
        raise TypeError(
            f"value {parameter_value!r} has no parameter type: expected bool, "
            "int, float, str, or a list of bytes, bool, int, float or str"
        )

    def check(self, parameter_value: Any) -> bool:
        if self is ParameterType.NOT_SET:
            return parameter_value is None
        if self in _SCALARS:
            if self is not ParameterType.BOOL and isinstance(parameter_value, bool):
                return False
            return isinstance(parameter_value, _SCALARS[self])
        return _is_array(parameter_value) and all(
            _is_item(item, _ITEMS[self]) for item in parameter_value
        )


# Order matters: a bool is also an int.
_SCALARS: dict[ParameterType, type] = {
    ParameterType.BOOL: bool,
    ParameterType.INTEGER: int,
    ParameterType.DOUBLE: float,
    ParameterType.STRING: str,
}
_ITEMS: dict[ParameterType, type] = {
    ParameterType.BYTE_ARRAY: bytes,
    ParameterType.BOOL_ARRAY: bool,
    ParameterType.INTEGER_ARRAY: int,
    ParameterType.DOUBLE_ARRAY: float,
    ParameterType.STRING_ARRAY: str,
}
_VALUE_FIELDS: dict[ParameterType, str] = {
    kind: f"{kind.name.lower()}_value" for kind in ParameterType if kind
}


def _is_array(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.ndim == 1
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def _is_numeric_array(value: Any) -> bool:
    return _is_array(value) and all(
        _is_item(item, int) or _is_item(item, float) for item in value
    )


def _is_item(item: Any, wanted: type) -> bool:
    if wanted is bytes:
        return isinstance(item, bytes) and len(item) == 1
    if isinstance(item, np.generic):
        item = item.item()
    return isinstance(item, wanted) and not (wanted is int and isinstance(item, bool))


class Parameter(Generic[T]):
    """A parameter: name, type and value."""

    Type = ParameterType

    __slots__ = ("_name", "_type", "_value")

    def __init__(
        self, name: str, type_: ParameterType | None = None, value: Any = None
    ) -> None:
        if type_ is None:
            type_ = ParameterType.from_parameter_value(value)
        if not isinstance(type_, ParameterType):
            raise TypeError(f"type_ must be a Parameter.Type, got {type_!r}")
        if not type_.check(value):
            raise ValueError(
                f"parameter {name!r}: value {value!r} is not of type {type_.name}"
            )
        self._name = name
        self._type = type_
        self._value = value

    @property
    def name(self) -> str:
        return self._name

    @property
    def type_(self) -> ParameterType:
        return self._type

    @property
    def value(self) -> Any:
        return self._value

    def __repr__(self) -> str:
        return f"Parameter({self._name!r}, {self._type.name}, {self._value!r})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Parameter):
            return NotImplemented
        return (self._name, self._type, _plain(self._value)) == (
            other._name,
            other._type,
            _plain(other._value),
        )

    def __hash__(self) -> int:
        return hash((self._name, self._type))  # values may be lists

    def get_parameter_value(self) -> ParameterValue:
        message = ParameterValue(type=int(self._type))
        if self._type is not ParameterType.NOT_SET:
            setattr(message, _VALUE_FIELDS[self._type], _plain(self._value))
        return message

    def to_parameter_msg(self) -> ParameterMsg:
        return ParameterMsg(name=self._name, value=self.get_parameter_value())

    @classmethod
    def from_parameter_msg(cls, param_msg: ParameterMsg) -> "Parameter[Any]":
        """Return the message's parameter; raise ParameterError for an unknown type."""
        kind = param_msg.value.type
        if kind not in set(ParameterType):
            raise ParameterError(
                f"parameter {param_msg.name!r}: type {kind}; known: "
                f"0 … {max(ParameterType):d}"
            )
        value = parameter_value_to_python(param_msg.value)
        return cls(param_msg.name, ParameterType(kind), value)


def _plain(value: Any) -> Any:
    """Convert an array to a list of Python items."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return list(value) if _is_array(value) else value


def parameter_value_to_python(parameter_value: ParameterValue) -> Any:
    """Return the Python value of a ParameterValue; None if it is not set."""
    kind = ParameterType(parameter_value.type)
    if kind is ParameterType.NOT_SET:
        return None
    value = getattr(parameter_value, _VALUE_FIELDS[kind])
    return _plain(value) if kind >= ParameterType.BYTE_ARRAY else value


def get_parameter_value(string_value: str) -> ParameterValue:
    """Return the value of a text, read as YAML; a string if it is not YAML."""
    from navette.runtime.parameter_files import parse_value

    return Parameter("text", value=parse_value(string_value)).get_parameter_value()


def parameter_dict_from_yaml_file(
    parameter_file: Path | str,
    use_wildcard: bool = False,
    target_nodes: list[str] | None = None,
    namespace: str = "",
) -> dict[str, ParameterMsg]:
    """Return the parameter messages of a ROS 2 parameter file by name.

    Args:
        use_wildcard: include the values for ``/**``; values for a node take precedence.
        target_nodes: nodes of the file to read; all if None or empty.
        namespace: prefix for every name.

    Raises:
        FileFormatError: the file is not a parameter file.
        ParameterError: a target node is not in the file, or no parameter is selected.
    """
    from navette.runtime.parameter_files import read_parameter_file

    entries = read_parameter_file(parameter_file)
    wanted = [f"/{name.strip('/')}" for name in target_nodes or ()]
    missing = set(wanted) - {pattern for pattern, _ in entries}
    if missing:
        raise ParameterError(
            f"{parameter_file}: nothing for {', '.join(sorted(missing))}; nodes: "
            f"{', '.join(pattern for pattern, _ in entries)}"
        )
    every = [each for each in entries if each[0] == "/**"] if use_wildcard else []
    named = [p for p in entries if p[0] != "/**" and (not wanted or p[0] in wanted)]
    if not every and not named:
        raise ParameterError(f"{parameter_file}: no selected parameters")
    return {
        namespace + name: Parameter(namespace + name, value=value).to_parameter_msg()
        for _, values in (*every, *named)
        for name, value in values.items()
    }


def coerced(name: str, value: Any, wanted: ParameterType) -> Any:
    """Convert a value to the declared type: an int to a double, [] to any list.

    Raises:
        ParameterError: names the parameter, the value and the expected type.
    """
    widens = not is_strict()
    if widens and wanted is ParameterType.DOUBLE and ParameterType.INTEGER.check(value):
        return float(value)
    if widens and wanted is ParameterType.DOUBLE_ARRAY and _is_numeric_array(value):
        return [float(v) for v in value]
    if wanted in _ITEMS and _is_array(value) and len(value) == 0:
        return []
    if not wanted.check(value):
        try:
            got = ParameterType.from_parameter_value(value).name
        except TypeError:
            got = type(value).__name__
        raise ParameterError(
            f"parameter {name!r}: {value!r} is {got}, expected {wanted.name}"
        )
    return value


def is_close_to_step(value: float, start: float, step: float, rel_tol: float) -> bool:
    """Whether ``value`` is a whole number of steps from ``start``."""
    steps = round((value - start) / step)
    return math.isclose(start + steps * step, value, rel_tol=rel_tol)
