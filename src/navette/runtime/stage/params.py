"""A stage's parameters, written once as a dataclass, declared as ROS parameters."""

import dataclasses
import types
import typing
from typing import Any, TypeVar

from navette.errors import ParameterError
from navette.msgs.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
)
from navette.params import ParamInfo, Params, info_of
from navette.runtime.node import Node
from navette.runtime.parameter import Parameter, ParameterType

P = TypeVar("P", bound=Params)

_TYPES: dict[Any, ParameterType] = {
    bool: ParameterType.BOOL,
    int: ParameterType.INTEGER,
    float: ParameterType.DOUBLE,
    str: ParameterType.STRING,
}
_ARRAYS: dict[Any, ParameterType] = {
    bool: ParameterType.BOOL_ARRAY,
    int: ParameterType.INTEGER_ARRAY,
    float: ParameterType.DOUBLE_ARRAY,
    str: ParameterType.STRING_ARRAY,
}


def declare_params(node: Node, params_class: type[P]) -> P:
    """Declare every field with its text and range; the values as a ``Params``.

    Raises:
        ParameterError: names node, parameter, value and what is allowed.
    """
    hints = typing.get_type_hints(params_class)
    defaults = params_class()
    for field in dataclasses.fields(params_class):
        kind = parameter_type(hints[field.name])
        default = getattr(defaults, field.name)
        # As a message, an empty list keeps its type.
        value: Parameter[Any] = Parameter(
            field.name, kind, list(default) if isinstance(default, tuple) else default
        )
        descriptor = _descriptor(info_of(field), kind)
        node.declare_parameter(field.name, value.get_parameter_value(), descriptor)
    return params_from(node, params_class)


def params_from(node: Node, params_class: type[P]) -> P:
    """The declared values as a ``Params``, checked."""
    values = {
        field.name: node.get_parameter(field.name).value
        for field in dataclasses.fields(params_class)
    }
    try:
        return params_class.from_dict(values)
    except ParameterError as error:
        raise ParameterError(
            f"node {node.get_fully_qualified_name()}: {error}"
        ) from None


def parameter_type(hint: Any) -> ParameterType:
    """ROS 2's type for a field's annotation (bool, int, float, str or a tuple)."""
    if isinstance(hint, types.GenericAlias) and hint.__origin__ is tuple:
        return _ARRAYS[hint.__args__[0]]
    return _TYPES[hint]


def _descriptor(info: ParamInfo, kind: ParameterType) -> ParameterDescriptor:
    unit = f" [{info.unit}]" if info.unit else ""
    descriptor = ParameterDescriptor(
        description=f"{info.meaning}{unit}",
        additional_constraints="" if info.allowed() == "any" else info.allowed(),
    )
    low = info.at_least if info.at_least is not None else info.above
    high = info.at_most if info.at_most is not None else info.below
    # A ROS range has two ends; a one-sided bound is told in words only, and Params
    # checks it (as well as the open ends of a range).
    if low is None or high is None:
        return descriptor
    if kind is ParameterType.DOUBLE:
        bounds = FloatingPointRange(from_value=float(low), to_value=float(high))
        descriptor.floating_point_range = [bounds]
    elif kind is ParameterType.INTEGER:
        span = IntegerRange(from_value=int(low), to_value=int(high))
        descriptor.integer_range = [span]
    return descriptor
