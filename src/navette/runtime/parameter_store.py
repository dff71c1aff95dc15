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

_REL_TOL = 1e-6  # rclpy's PARAM_REL_TOL

PreCallback = Callable[[list[Parameter[Any]]], list[Parameter[Any]]]
OnCallback = Callable[[list[Parameter[Any]]], SetParametersResult]
PostCallback = Callable[[list[Parameter[Any]]], None]

Changes = tuple[list[Parameter[Any]], list[Parameter[Any]], list[Parameter[Any]]]
"""New, changed and deleted parameters of one change."""


class ParameterStore:
    """Values and descriptors of a node's parameters.

    Args:
        on_change: called after each change.
        allow_undeclared: whether parameters may be set without a declaration.
    """

    def __init__(
        self, on_change: Callable[[Changes], None], *, allow_undeclared: bool
    ) -> None:
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
        result = self._try_set([parameter], {name: descriptor})
        if not result.successful:
            reason = f"{result.reason} (from {origin})" if origin else result.reason
            raise InvalidParameterValueException(name, parameter.value, reason)

    def set(self, parameters: Sequence[Parameter[Any]]) -> SetParametersResult:
        """Set all parameters or none; the result contains the reason of a rejection."""
        wanted = list(parameters)
        for pre in self.pre_callbacks:
            wanted = pre(wanted)
        if self.pre_callbacks and not wanted:
            return SetParametersResult(
                successful=False,
                reason="the pre-set callbacks left no parameter to set",
            )
        try:
            wanted = [self._coerced(parameter) for parameter in wanted]
        except ParameterError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return self._try_set(wanted, None)

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
        wanted = ParameterType(descriptor.type)
        value = coerced(parameter.name, parameter.value, wanted)
        return Parameter(parameter.name, wanted, value)

    def _try_set(
        self,
        parameters: list[Parameter[Any]],
        descriptors: dict[str, ParameterDescriptor] | None,
    ) -> SetParametersResult:
        """Check all parameters, then store them; ``descriptors`` of a declaration."""
        for parameter in parameters:
            reason = self._rejection(parameter, descriptors)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
        for callback in self.on_callbacks:
            result: Any = callback(parameters)
            if not isinstance(result, SetParametersResult):  # a forgotten return
                raise AttributeError(
                    f"on-set-parameters callback {callback!r} returned {result!r}, "
                    "expected a SetParametersResult"
                )
            if not result.successful:
                return result
        self._on_change(self._store(parameters, descriptors))
        for post in self.post_callbacks:
            post(parameters)
        return SetParametersResult(successful=True)

    def _rejection(
        self,
        parameter: Parameter[Any],
        descriptors: dict[str, ParameterDescriptor] | None,
    ) -> str:
        name = parameter.name
        descriptor = (self.descriptors if descriptors is None else descriptors).get(
            name
        )
        if descriptor is None:
            return ""
        if descriptors is None and descriptor.read_only:
            return f"parameter {name!r} is read-only"
        if descriptor.dynamic_typing:
            descriptor.type = int(parameter.type_)
        elif parameter.type_ is ParameterType.NOT_SET:
            if descriptors is None:
                return f"static parameter {name!r} cannot be undeclared"
        elif parameter.type_ != descriptor.type:
            return (
                f"parameter {name!r}: {parameter.value!r} is {parameter.type_.name}, "
                f"expected {ParameterType(descriptor.type).name}"
            )
        return _range_rejection(parameter, descriptor)

    def _store(
        self,
        parameters: list[Parameter[Any]],
        descriptors: dict[str, ParameterDescriptor] | None,
    ) -> Changes:
        new: list[Parameter[Any]] = []
        changed: list[Parameter[Any]] = []
        deleted: list[Parameter[Any]] = []
        for parameter in parameters:
            name = parameter.name
            if descriptors is None and parameter.type_ is ParameterType.NOT_SET:
                deleted.append(parameter)
                self.values.pop(name, None)
                self.descriptors.pop(name, None)
                continue
            if descriptors is not None:
                self.descriptors[name] = descriptors[name]
            elif name not in self.descriptors:
                self.descriptors[name] = ParameterDescriptor(
                    name=name, type=int(parameter.type_), dynamic_typing=True
                )
            before = self.values.get(name)
            is_new = before is None or before.type_ is ParameterType.NOT_SET
            (new if is_new else changed).append(parameter)
            self.values[name] = parameter
        return new, changed, deleted


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
    tolerance = 0.0 if exact else _REL_TOL
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
