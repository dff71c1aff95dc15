"""The parameter half of :class:`Node`, as rclpy has it."""

import copy
from collections.abc import Sequence
from typing import Any

from navette.errors import ParameterError
from navette.msgs.rcl_interfaces.msg import (
    ListParametersResult,
    ParameterDescriptor,
    ParameterValue,
    SetParametersResult,
)
from navette.runtime.exceptions import (
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from navette.runtime.overrides import Override
from navette.runtime.parameter import (
    PARAMETER_SEPARATOR_STRING,
    Parameter,
    ParameterType,
    coerced,
    parameter_value_to_python,
    validate_parameter_name,
)
from navette.runtime.parameter_store import (
    OnCallback,
    ParameterStore,
    PostCallback,
    PreCallback,
)


class NodeParameters:
    """Declare, get, set, describe. Mixed into :class:`Node`."""

    _store: ParameterStore
    #: Values given from outside.
    _overrides: dict[str, Override]

    def get_fully_qualified_name(self) -> str:
        raise NotImplementedError

    # -- declaring -------------------------------------------------------------

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[Any]:
        """Declare with a default value or a ``Parameter.Type``.

        Values from files, launch and command line come before the default.

        Raises:
            ParameterError: declared already, or a value is refused.
        """
        entry = (name, value) if descriptor is None else (name, value, descriptor)
        if value is None and descriptor is None:
            entry = (name,)  # type: ignore[assignment]
        return self.declare_parameters("", [entry], ignore_override)[0]

    def declare_parameters(
        self,
        namespace: str,
        parameters: Sequence[tuple[Any, ...]],
        ignore_override: bool = False,
    ) -> list[Parameter[Any]]:
        """Declare (name[, value or type[, descriptor]]) as ``namespace.name``."""
        declared = []
        for entry in parameters:
            if not 1 <= len(entry) <= 3:
                raise TypeError(
                    f"parameter tuple {entry!r}: wanted (name[, value[, descriptor]])"
                )
            name = f"{namespace}.{entry[0]}" if namespace else entry[0]
            value = entry[1] if len(entry) > 1 else None
            descriptor = entry[2] if len(entry) > 2 else ParameterDescriptor()
            # A bare name says nothing of the type: it may hold any (as rclpy).
            if len(entry) == 1:
                descriptor.dynamic_typing = True
            declared.append(self._declare(name, value, descriptor, ignore_override))
        return declared

    def _declare(
        self, name: str, value: Any, descriptor: Any, ignore_override: bool
    ) -> Parameter[Any]:
        validate_parameter_name(name)
        if not isinstance(descriptor, ParameterDescriptor):
            raise TypeError(f"parameter {name!r}: {descriptor!r} is no descriptor")
        # The node keeps its own: one descriptor object may serve many parameters.
        descriptor = copy.copy(descriptor)
        kind = _declared_type(name, value, descriptor)
        if isinstance(value, (ParameterType, ParameterValue)):
            value = (
                parameter_value_to_python(value)
                if isinstance(value, ParameterValue)
                else None
            )
        origin = ""
        if not ignore_override and name in self._overrides:
            value, origin, _ = self._overrides[name]
        if kind is None:
            parameter: Parameter[Any] = Parameter(name, value=value)
        elif value is None:
            parameter = Parameter(name, ParameterType.NOT_SET)
        else:
            parameter = Parameter(name, kind, self._typed(name, value, kind, origin))
        self._store.declare(parameter, descriptor, origin)
        return self._store.values[name]

    def _typed(self, name: str, value: Any, kind: ParameterType, origin: str) -> Any:
        try:
            return coerced(name, value, kind)
        except ParameterError as error:
            where = f" (from {origin})" if origin else ""
            node = self.get_fully_qualified_name()
            raise ParameterError(f"node {node}: {error}{where}") from None

    def undeclare_parameter(self, name: str) -> None:
        self._declared(name)
        if self._store.descriptors[name].read_only:
            raise ParameterImmutableException(name)
        self._store.remove(name)

    def has_parameter(self, name: str) -> bool:
        return name in self._store.values

    # -- reading ---------------------------------------------------------------

    def get_parameter(self, name: str) -> Parameter[Any]:
        """The parameter; raises if it is not declared or has no value."""
        parameter = self._known(name)
        if (
            parameter.type_ is ParameterType.NOT_SET
            and name in self._store.descriptors
            and not self._store.descriptors[name].dynamic_typing
        ):
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameters(self, names: list[str]) -> list[Parameter[Any]]:
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(
        self, name: str, alternative_value: Parameter[Any] | None = None
    ) -> Parameter[Any]:
        """The parameter, or the alternative where it has no value."""
        parameter = self._store.values.get(name)
        if parameter is not None and parameter.type_ is not ParameterType.NOT_SET:
            return parameter
        return alternative_value or Parameter(name, ParameterType.NOT_SET)

    def get_parameter_type(self, name: str) -> ParameterType:
        return self._known(name).type_

    def get_parameter_types(self, names: list[str]) -> list[ParameterType]:
        return [self.get_parameter_type(name) for name in names]

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Parameters below ``prefix.``, by the rest of their names."""
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {
            name[len(start) :]: parameter
            for name, parameter in self._store.values.items()
            if name.startswith(start)
        }

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Names at most ``depth`` levels below any prefix; depth 0 = all levels."""
        if depth < 0:
            raise ValueError("depth must be greater than or equal to zero")
        result = ListParametersResult()
        names = [
            name for name in self._store.values if _is_listed(name, prefixes, depth)
        ]
        result.names = names
        found = (n.rpartition(PARAMETER_SEPARATOR_STRING)[0] for n in names)
        result.prefixes = list(dict.fromkeys(prefix for prefix in found if prefix))
        return result

    def known_parameters(self) -> list[str] | None:
        """Declared names; None if the node takes undeclared ones too."""
        return None if self._store.allow_undeclared else list(self._store.values)

    # -- setting ---------------------------------------------------------------

    def set_parameters(
        self, parameter_list: list[Parameter[Any]]
    ) -> list[SetParametersResult]:
        """Set one by one; refusals come back in the results."""
        self._check_declared(parameter_list)
        return [self._store.set([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(
        self, parameter_list: list[Parameter[Any]]
    ) -> SetParametersResult:
        """Set all or none."""
        self._check_declared(parameter_list)
        return self._store.set(parameter_list)

    def add_pre_set_parameters_callback(self, callback: PreCallback) -> None:
        """May alter the list before it is checked."""
        self._store.pre_callbacks.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnCallback) -> None:
        """May refuse the values."""
        self._store.on_callbacks.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostCallback) -> None:
        """Is told after the values were taken over."""
        self._store.post_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreCallback) -> None:
        self._store.pre_callbacks.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnCallback) -> None:
        self._store.on_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostCallback) -> None:
        self._store.post_callbacks.remove(callback)

    # -- descriptors -----------------------------------------------------------

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        if name not in self._store.descriptors:
            if self._store.allow_undeclared:
                return ParameterDescriptor(name=name)
            self._known(name)
        return self._store.descriptors[name]

    def describe_parameters(self, names: list[str]) -> list[ParameterDescriptor]:
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self,
        name: str,
        descriptor: ParameterDescriptor,
        alternative_value: ParameterValue | None = None,
    ) -> ParameterValue:
        """Replace the descriptor; the value must fit it, or the alternative is set."""
        self._declared(name)
        if self._store.descriptors[name].read_only:
            raise ParameterImmutableException(name)
        old = self._store.values[name], self._store.descriptors[name]
        parameter = old[0]
        if alternative_value is not None:
            value = parameter_value_to_python(alternative_value)
            parameter = Parameter(name, value=value)
        self._store.remove(name)
        descriptor = copy.copy(descriptor)
        descriptor.type = int(parameter.type_)
        try:
            self._store.declare(parameter, descriptor, "set_descriptor")
        except ParameterError:
            self._store.values[name], self._store.descriptors[name] = old
            raise
        return self._store.values[name].get_parameter_value()

    # -- inside ----------------------------------------------------------------

    def _known(self, name: str) -> Parameter[Any]:
        if self._store.allow_undeclared and name not in self._store.values:
            return Parameter(name, ParameterType.NOT_SET)
        return self._declared(name)

    def _declared(self, name: str) -> Parameter[Any]:
        parameter = self._store.values.get(name)
        if parameter is None:
            raise ParameterNotDeclaredException(
                name, self.get_fully_qualified_name(), list(self._store.values)
            )
        return parameter

    def _check_declared(self, parameters: Sequence[Parameter[Any]]) -> None:
        for parameter in parameters:
            if not isinstance(parameter, Parameter):
                raise TypeError(f"wanted a Parameter, got {parameter!r}")
            self._known(parameter.name)


def _declared_type(
    name: str, value: Any, descriptor: ParameterDescriptor
) -> ParameterType | None:
    """The static type, noted in the descriptor; None for dynamic typing."""
    kind: ParameterType
    if isinstance(value, ParameterType):
        if value is ParameterType.NOT_SET or descriptor.dynamic_typing:
            raise ParameterError(
                f"parameter {name!r}: declare a static type other than NOT_SET, or "
                "dynamic_typing without a type"
            )
        kind = value
    elif descriptor.dynamic_typing:
        return None
    elif isinstance(value, ParameterValue):
        kind = ParameterType(value.type)
    else:
        kind = ParameterType.from_parameter_value(value)
    if kind is ParameterType.NOT_SET:
        raise ParameterError(
            f"parameter {name!r}: a statically typed parameter needs a default value "
            "or a type"
        )
    descriptor.type = int(kind)
    return kind


def _is_listed(name: str, prefixes: list[str], depth: int) -> bool:
    if not prefixes:
        return depth == 0 or name.count(PARAMETER_SEPARATOR_STRING) < depth
    for prefix in prefixes:
        start = prefix + PARAMETER_SEPARATOR_STRING
        if name == prefix:
            return True
        if name.startswith(start):
            below = name[len(start) :].count(PARAMETER_SEPARATOR_STRING)
            if depth == 0 or below < depth:
                return True
    return False
