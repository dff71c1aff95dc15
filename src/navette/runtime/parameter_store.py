"""The declared parameters of one node: descriptors, checks, callbacks."""

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
    """Values and descriptors; ``on_change`` is told what each change did."""

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

        Raises:
            ParameterError: declared already, or the value is refused; ``origin``
                says where the value came from.
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
        """Set all of them or none; refusals come back in the result."""
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
        """An int becomes a double where a double is declared."""
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
        """Check everything, then take it over; ``descriptors`` = being declared."""
        for parameter in parameters:
            reason = self._objection(parameter, descriptors)
            if reason:
                return SetParametersResult(successful=False, reason=reason)
        for callback in self.on_callbacks:
            result: Any = callback(parameters)
            if not isinstance(result, SetParametersResult):  # a forgotten return
                raise AttributeError(
                    f"on-set-parameters callback {callback!r} returned {result!r}, "
                    "wanted a SetParametersResult"
                )
            if not result.successful:
                return result
        self._on_change(self._take_over(parameters, descriptors))
        for post in self.post_callbacks:
            post(parameters)
        return SetParametersResult(successful=True)

    def _objection(
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
                f"wanted {ParameterType(descriptor.type).name}"
            )
        return _range_objection(parameter, descriptor)

    def _take_over(
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


def _range_objection(parameter: Parameter[Any], descriptor: ParameterDescriptor) -> str:
    """Why the value is outside the descriptor's range or between its steps."""
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
