"""Declared parameters of one node, with descriptors, checks and callbacks."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from navette.errors import ParameterError
from navette.msgs.rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from navette.runtime.exceptions import (
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
)
from navette.runtime.parameter import (
    Parameter,
    ParameterType,
    coerced,
    is_close_to_step,
)

#: Tolerance at the edges of a parameter's range, relative; rclpy's PARAM_REL_TOL.
REL_TOL = 1e-6

PreCallback = Callable[[list[Parameter[Any]]], list[Parameter[Any]]]
OnCallback = Callable[[list[Parameter[Any]]], SetParametersResult]
PostCallback = Callable[[list[Parameter[Any]]], None]

Changes = tuple[list[Parameter[Any]], list[Parameter[Any]], list[Parameter[Any]]]
"""New, changed and deleted parameters of one change."""

OnChanges = Callable[[Changes], None]
"""Called after parameters were declared, set or undeclared."""


class ParameterStore:
    """Values and descriptors of a node's parameters.

    Args:
        allow_undeclared: whether parameters may be set without a declaration.
    """

    def __init__(self, *, on_change: OnChanges, allow_undeclared: bool) -> None:
        self.values: dict[str, Parameter[Any]] = {}
        self.descriptors: dict[str, ParameterDescriptor] = {}
        self.pre_callbacks: list[PreCallback] = []
        self.on_callbacks: list[OnCallback] = []
        self.post_callbacks: list[PostCallback] = []
        self.allow_undeclared = allow_undeclared
        self._on_change = on_change

    def declare(self, parameter: Parameter[Any], descriptor: Any, origin: str) -> None:
        """Add a parameter with its first value.

        Args:
            origin: where the value comes from, for error messages; may be empty.

        Raises:
            ParameterError: the parameter is declared already, or its value is rejected.
        """
        name = parameter.name
        if name in self.values:
            raise ParameterAlreadyDeclaredException(name)
        descriptor.name = name
        if descriptor.dynamic_typing:
            descriptor.type = int(parameter.type_)
        reason = _range_rejection(parameter, descriptor)
        result = _rejected(reason) if reason else self._run_callbacks([parameter])
        if not result.successful:
            reason = f"{result.reason} (from {origin})" if origin else result.reason
            raise InvalidParameterValueException(name, parameter.value, reason)
        self.descriptors[name] = descriptor
        self.values[name] = parameter
        self._report(([parameter], [], []), [parameter])

    def set(self, parameters: Sequence[Parameter[Any]]) -> SetParametersResult:
        """Set all parameters or none; the result contains the reason of a rejection."""
        requested = list(parameters)
        for pre in self.pre_callbacks:
            requested = pre(requested)
        if self.pre_callbacks and not requested:
            return _rejected("the pre-set callbacks left no parameter to set")
        try:
            requested = [self._coerced(parameter) for parameter in requested]
        except ParameterError as error:
            return _rejected(str(error))
        for parameter in requested:
            reason = self._rejection(parameter)
            if reason:
                return _rejected(reason)
        result = self._run_callbacks(requested)
        if result.successful:
            self._report(self._store(requested), requested)
        return result

    def remove(self, name: str) -> None:
        del self.values[name]
        self.descriptors.pop(name, None)

    def _coerced(self, parameter: Parameter[Any]) -> Parameter[Any]:
        """Convert the value to the declared type."""
        descriptor = self.descriptors.get(parameter.name)
        if (
            descriptor is None
            or descriptor.dynamic_typing
            or parameter.type_ is ParameterType.NOT_SET
        ):
            return parameter
        declared = ParameterType(descriptor.type)
        value = coerced(parameter.name, parameter.value, declared)
        return Parameter(parameter.name, declared, value)

    def _rejection(self, parameter: Parameter[Any]) -> str:
        """Return why the descriptor rejects a new value; empty if it does not."""
        name = parameter.name
        descriptor = self.descriptors.get(name)
        if descriptor is None:
            return ""
        if descriptor.read_only:
            return f"parameter {name!r} is read-only"
        if descriptor.dynamic_typing:
            descriptor.type = int(parameter.type_)
        elif parameter.type_ is ParameterType.NOT_SET:
            return f"static parameter {name!r} cannot be undeclared"
        return _range_rejection(parameter, descriptor)

    def _run_callbacks(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        for callback in self.on_callbacks:
            result: Any = callback(parameters)
            if not isinstance(result, SetParametersResult):  # a forgotten return
                raise AttributeError(
                    f"on-set-parameters callback {callback!r} returned {result!r}, "
                    "expected a SetParametersResult"
                )
            if not result.successful:
                return result
        return SetParametersResult(successful=True)

    def _store(self, parameters: list[Parameter[Any]]) -> Changes:
        changes: Changes = ([], [], [])
        new, changed, deleted = changes
        for parameter in parameters:
            name = parameter.name
            if parameter.type_ is ParameterType.NOT_SET:
                deleted.append(parameter)
                self.values.pop(name, None)
                self.descriptors.pop(name, None)
                continue
            if name not in self.descriptors:
                self.descriptors[name] = ParameterDescriptor(
                    name=name, type=int(parameter.type_), dynamic_typing=True
                )
            before = self.values.get(name)
            is_new = before is None or before.type_ is ParameterType.NOT_SET
            (new if is_new else changed).append(parameter)
            self.values[name] = parameter
        return changes

    def _report(self, changes: Changes, parameters: list[Parameter[Any]]) -> None:
        self._on_change(changes)
        for post in self.post_callbacks:
            post(parameters)


def _rejected(reason: str) -> SetParametersResult:
    return SetParametersResult(successful=False, reason=reason)


def _range_rejection(parameter: Parameter[Any], descriptor: ParameterDescriptor) -> str:
    """Return why the descriptor's range rejects the value; empty if it does not."""
    bounds: Any
    if parameter.type_ is ParameterType.INTEGER and descriptor.integer_range:
        bounds, exact = descriptor.integer_range[0], True
    elif parameter.type_ is ParameterType.DOUBLE and descriptor.floating_point_range:
        bounds, exact = descriptor.floating_point_range[0], False
    else:
        return ""
    value = parameter.value
    low = min(bounds.from_value, bounds.to_value)
    high = max(bounds.from_value, bounds.to_value)
    tolerance = 0.0 if exact else REL_TOL
    if any(math.isclose(value, edge, rel_tol=tolerance) for edge in (low, high)):
        return ""
    if not low < value < high:
        return (
            f"parameter {parameter.name!r}: {value!r} is out of range "
            f"{low:g} … {high:g}"
        )
    if bounds.step and not is_close_to_step(value, low, bounds.step, tolerance):
        return (
            f"parameter {parameter.name!r}: {value!r} is not a step of "
            f"{bounds.step:g} from {low:g}"
        )
    return ""
