"""Declaration of a stage's parameters, a :class:`Params` dataclass, on a node."""

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
    """Declare every field as a parameter of the node and return the values.

    A value from a file, a launch file or the command line replaces the field's default.
    Fields that are declared already keep their values.

    Raises:
        ParameterError: names the node, the parameter, its value and the allowed values.
    """
    hints = typing.get_type_hints(params_class)
    defaults = params_class()
    values = {
        field.name: _declare(node, field, hints[field.name], defaults)
        for field in dataclasses.fields(params_class)
    }
    try:
        return params_class(**values)
    except ParameterError as error:
        raise ParameterError(
            f"node {node.get_fully_qualified_name()}: {error}"
        ) from None


def _declare(
    node: Node, field: "dataclasses.Field[Any]", hint: Any, defaults: Params
) -> Any:
    if node.has_parameter(field.name):
        return node.get_parameter(field.name).value
    kind = _parameter_type(hint)
    default = getattr(defaults, field.name)
    if isinstance(default, tuple):
        default = list(default)
    parameter: Parameter[Any] = Parameter(field.name, kind, default)
    # As a message, because an empty list alone has no type.
    message = parameter.get_parameter_value()
    descriptor = _descriptor(info_of(field), kind)
    return node.declare_parameter(field.name, message, descriptor).value


def _parameter_type(hint: Any) -> ParameterType:
    """Return ROS 2's type for an annotation: bool, int, float, str or a tuple."""
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
    # A range of ROS 2 has two closed ends. The text describes other bounds, and Params
    # checks them.
    if low is None or high is None:
        return descriptor
    if kind is ParameterType.DOUBLE:
        bounds = FloatingPointRange(from_value=float(low), to_value=float(high))
        descriptor.floating_point_range = [bounds]
    elif kind is ParameterType.INTEGER:
        span = IntegerRange(from_value=int(low), to_value=int(high))
        descriptor.integer_range = [span]
    return descriptor
