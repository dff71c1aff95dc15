"""The parameters of one node: declaration, access and descriptors."""

import copy
from collections.abc import Mapping, Sequence
from typing import Any

from navette.errors import ParameterError
from navette.msgs.rcl_interfaces.msg import (
    ListParametersResult,
    ParameterDescriptor,
    ParameterValue,
    SetParametersResult,
)
from navette.runtime.exceptions import (
    OverrideTypeError,
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
    OnChanges,
    ParameterStore,
    PostCallback,
    PreCallback,
)


class NodeParameters:
    """Base class of :class:`Node`: the parameters of a node.

    Args:
        node_name: full name, for error messages.
        overrides: values from files, launch and command line, by parameter name.
        allow_undeclared: whether undeclared parameters can be read and set.
    """

    def __init__(
        self,
        node_name: str,
        overrides: Mapping[str, Override],
        *,
        on_change: OnChanges,
        allow_undeclared: bool,
    ) -> None:
        self._node_full_name = node_name
        self._node_overrides = overrides
        self._node_store = ParameterStore(
            on_change=on_change, allow_undeclared=allow_undeclared
        )

    def declare_parameter(
        self,
        name: str,
        value: Any = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[Any]:
        """Declare a parameter with a default value or a ``Parameter.Type``.

        Values from files, launch and command line take precedence over the default.

        Raises:
            ParameterError: declared before, or the value is rejected.
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
                    f"parameter tuple {entry!r} must be (name[, value[, descriptor]])"
                )
            name = f"{namespace}.{entry[0]}" if namespace else entry[0]
            value = entry[1] if len(entry) > 1 else None
            descriptor = entry[2] if len(entry) > 2 else ParameterDescriptor()
            # A name without value and type is dynamically typed, as in rclpy.
            if len(entry) == 1:
                descriptor.dynamic_typing = True
            declared.append(
                self._node_declare(name, value, descriptor, ignore_override)
            )
        return declared

    def _node_declare(
        self, name: str, value: Any, descriptor: Any, ignore_override: bool
    ) -> Parameter[Any]:
        validate_parameter_name(name)
        if not isinstance(descriptor, ParameterDescriptor):
            raise TypeError(
                f"parameter {name!r}: descriptor must be a ParameterDescriptor, got "
                f"{descriptor!r}"
            )
        # Copied: a program may use one descriptor object for many parameters.
        descriptor = copy.copy(descriptor)
        kind = _declared_type(name, value, descriptor)
        if isinstance(value, (ParameterType, ParameterValue)):
            value = (
                parameter_value_to_python(value)
                if isinstance(value, ParameterValue)
                else None
            )
        origin = ""
        if not ignore_override and name in self._node_overrides:
            value, origin, _ = self._node_overrides[name]
        if kind is None:
            parameter: Parameter[Any] = Parameter(name, value=value)
        elif value is None:
            parameter = Parameter(name, ParameterType.NOT_SET)
        else:
            parameter = Parameter(
                name, kind, self._node_typed(name, value, kind, origin)
            )
        self._node_store.declare(parameter, descriptor, origin)
        return self._node_store.values[name]

    def _node_typed(
        self, name: str, value: Any, kind: ParameterType, origin: str
    ) -> Any:
        try:
            return coerced(name, value, kind)
        except ParameterError as error:
            where = f" (from {origin})" if origin else ""
            raise OverrideTypeError(
                f"node {self._node_full_name}: {error}{where}", name
            ) from None

    def undeclare_parameter(self, name: str) -> None:
        self._node_declared(name)
        if self._node_store.descriptors[name].read_only:
            raise ParameterImmutableException(name)
        self._node_store.remove(name)

    def has_parameter(self, name: str) -> bool:
        return name in self._node_store.values

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Return the parameter.

        Raises:
            ParameterNotDeclaredException: not declared, and the node requires it.
            ParameterUninitializedException: declared with a type and without a value.
        """
        parameter = self._node_known(name)
        if (
            parameter.type_ is ParameterType.NOT_SET
            and name in self._node_store.descriptors
            and not self._node_store.descriptors[name].dynamic_typing
        ):
            raise ParameterUninitializedException(name)
        return parameter

    def get_parameters(self, names: list[str]) -> list[Parameter[Any]]:
        return [self.get_parameter(name) for name in names]

    def get_parameter_or(
        self, name: str, alternative_value: Parameter[Any] | None = None
    ) -> Parameter[Any]:
        """Return the parameter, or the alternative if it has no value."""
        parameter = self._node_store.values.get(name)
        if parameter is not None and parameter.type_ is not ParameterType.NOT_SET:
            return parameter
        return alternative_value or Parameter(name, ParameterType.NOT_SET)

    def get_parameter_type(self, name: str) -> ParameterType:
        return self._node_known(name).type_

    def get_parameter_types(self, names: list[str]) -> list[ParameterType]:
        return [self.get_parameter_type(name) for name in names]

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Return the parameters below ``prefix.``, keyed by the rest of the name."""
        start = prefix + PARAMETER_SEPARATOR_STRING if prefix else ""
        return {
            name[len(start) :]: parameter
            for name, parameter in self._node_store.values.items()
            if name.startswith(start)
        }

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """List names at most ``depth`` levels below any prefix; 0 means all levels."""
        if depth < 0:
            raise ValueError(f"depth must be >= 0, got {depth}")
        result = ListParametersResult()
        names = [
            name
            for name in self._node_store.values
            if _is_listed(name, prefixes, depth)
        ]
        result.names = names
        found = (n.rpartition(PARAMETER_SEPARATOR_STRING)[0] for n in names)
        result.prefixes = list(dict.fromkeys(prefix for prefix in found if prefix))
        return result

    def _node_known_parameters(self) -> list[str] | None:
        """Return the declared names; None if undeclared parameters are allowed."""
        return (
            None if self._node_store.allow_undeclared else list(self._node_store.values)
        )

    def set_parameters(
        self, parameter_list: list[Parameter[Any]]
    ) -> list[SetParametersResult]:
        """Set the parameters one by one; the results contain the rejections."""
        self._node_check_declared(parameter_list)
        return [self._node_store.set([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(
        self, parameter_list: list[Parameter[Any]]
    ) -> SetParametersResult:
        """Set all of the parameters or none."""
        self._node_check_declared(parameter_list)
        return self._node_store.set(parameter_list)

    def add_pre_set_parameters_callback(self, callback: PreCallback) -> None:
        """Add a callback that may change the list before it is checked."""
        self._node_store.pre_callbacks.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnCallback) -> None:
        """Add a callback that may reject the values."""
        self._node_store.on_callbacks.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostCallback) -> None:
        """Add a callback that runs after the values were set."""
        self._node_store.post_callbacks.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreCallback) -> None:
        self._node_store.pre_callbacks.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnCallback) -> None:
        self._node_store.on_callbacks.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostCallback) -> None:
        self._node_store.post_callbacks.remove(callback)

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        if name not in self._node_store.descriptors:
            if self._node_store.allow_undeclared:
                return ParameterDescriptor(name=name)
            self._node_known(name)
        return self._node_store.descriptors[name]

    def describe_parameters(self, names: list[str]) -> list[ParameterDescriptor]:
        return [self.describe_parameter(name) for name in names]

    def set_descriptor(
        self,
        name: str,
        descriptor: ParameterDescriptor,
        alternative_value: ParameterValue | None = None,
    ) -> ParameterValue:
        """Replace the descriptor; set the alternative if the value does not fit it."""
        self._node_declared(name)
        if self._node_store.descriptors[name].read_only:
            raise ParameterImmutableException(name)
        old = (
            self._node_store.values[name],
            self._node_store.descriptors[name],
        )
        parameter = old[0]
        if alternative_value is not None:
            value = parameter_value_to_python(alternative_value)
            parameter = Parameter(name, value=value)
        self._node_store.remove(name)
        descriptor = copy.copy(descriptor)
        descriptor.type = int(parameter.type_)
        try:
            self._node_store.declare(parameter, descriptor, "set_descriptor")
        except ParameterError:
            (
                self._node_store.values[name],
                self._node_store.descriptors[name],
            ) = old
            raise
        return self._node_store.values[name].get_parameter_value()

    def _node_known(self, name: str) -> Parameter[Any]:
        if self._node_store.allow_undeclared and name not in self._node_store.values:
            return Parameter(name, ParameterType.NOT_SET)
        return self._node_declared(name)

    def _node_declared(self, name: str) -> Parameter[Any]:
        parameter = self._node_store.values.get(name)
        if parameter is None:
            raise ParameterNotDeclaredException(
                name, self._node_full_name, list(self._node_store.values)
            )
        return parameter

    def _node_check_declared(self, parameters: Sequence[Parameter[Any]]) -> None:
        for parameter in parameters:
            if not isinstance(parameter, Parameter):
                raise TypeError(f"expected a Parameter, got {parameter!r}")
            self._node_known(parameter.name)


def _declared_type(
    name: str, value: Any, descriptor: ParameterDescriptor
) -> ParameterType | None:
    """Return the static type and store it in the descriptor; None if dynamic."""
    kind: ParameterType
    if isinstance(value, ParameterType):
        if value is ParameterType.NOT_SET or descriptor.dynamic_typing:
            raise ParameterError(
                f"parameter {name!r}: declare a static type other than NOT_SET, or set "
                "dynamic_typing in the descriptor and give no type"
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
