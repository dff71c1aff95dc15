"""Exceptions with rclpy's names, in Navette's exception hierarchy."""

# ruff: noqa: N818 - the names are rclpy's

from typing import Any, ClassVar

from navette.errors import (
    FileFormatError,
    InvalidNameError,
    InvalidValueError,
    NavetteError,
    ParameterError,
    UnknownNameError,
    instead_of,
)


class NotInitializedException(NavetteError):
    """The context has not been initialised."""

    def __init__(self, message: str | None = None) -> None:
        text = "call navette.init() (rclpy.init()) first: the context is not valid"
        super().__init__(f"{text}: {message}" if message else text)


class ROSInterruptException(NavetteError):
    """The context was shut down during a wait."""

    def __init__(self) -> None:
        super().__init__("the context was shut down while waiting")


class ExternalShutdownException(NavetteError):
    """The context was shut down during a spin."""


class InvalidHandle(NavetteError, RuntimeError):
    """A publisher or subscription was used after it was destroyed."""


class RCLError(NavetteError, RuntimeError):
    """An operation that ROS 2's client library rejects, as an invalid transition."""


class RosArgumentsError(InvalidValueError, RCLError):
    """A ROS argument of the command line has the wrong form."""


class ParameterFileError(FileFormatError, RCLError):
    """A parameter file of the command line cannot be read."""


class CallbackSignatureError(InvalidValueError, TypeError, RuntimeError):
    """A callback cannot take the arguments that it would be called with."""


class UnknownROSArgsError(RosArgumentsError):
    """A ROS argument of the command line is unknown."""


class ServiceFailedError(NavetteError, RuntimeError):
    """The server's callback raised an exception, so the request gets no response."""


class ServiceTimeoutError(ServiceFailedError, TimeoutError):
    """A server in another process did not respond within the transport's timeout."""


class ShutdownException(NavetteError):
    """The executor was shut down."""


class TimeoutException(NavetteError):
    """No callback became ready within the timeout."""


class ConditionReachedException(NavetteError):
    """The condition of a wait became true."""


class NodeNameNonExistentError(UnknownNameError):
    """A graph query names a node that does not exist."""


class NameValidationException(InvalidNameError):
    """A name is invalid at character ``invalid_index``."""

    def __init__(
        self, name_type: str, name: str, error_msg: str, invalid_index: int
    ) -> None:
        marker = " " * invalid_index + "^"
        super().__init__(f"invalid {name_type}: {error_msg}:\n  {name!r}\n   {marker}")
        self.name_type = name_type
        self.name = name
        self.error_msg = error_msg
        self.invalid_index = invalid_index


class _InvalidName(NameValidationException):
    """A name of the type ``kind`` is invalid."""

    kind: ClassVar[str]

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__(self.kind, name, error_msg, invalid_index)


class InvalidNamespaceException(_InvalidName):
    """A namespace is invalid."""

    kind = "namespace"


class InvalidNodeNameException(_InvalidName):
    """A node name is invalid."""

    kind = "node name"


class InvalidTopicNameException(_InvalidName):
    """A topic name is invalid."""

    kind = "topic name"


class InvalidServiceNameException(_InvalidName):
    """A service name is invalid."""

    kind = "service name"


class ParameterException(ParameterError):
    """Base of the parameter errors with rclpy's names."""

    def __init__(self, error_msg: str, parameters: str | list[str]) -> None:
        super().__init__(f"{error_msg}: {parameters}")
        self.parameters = parameters


class ParameterNotDeclaredException(ParameterException):
    """The node has not declared the parameter."""

    def __init__(
        self,
        parameters: str | list[str],
        node: str = "",
        known: list[str] | None = None,
    ) -> None:
        where = f" on node {node}" if node else ""
        text = f"parameter not declared{where}"
        if known is not None:
            name = parameters if isinstance(parameters, str) else ", ".join(parameters)
            see_all = f"navette param list {node}".rstrip()
            text += f" ({instead_of(name, known, see_all=see_all).removeprefix('; ')})"
        super().__init__(text, parameters)


class ParameterAlreadyDeclaredException(ParameterException):
    """The parameter was declared before."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("parameter already declared", parameters)


class InvalidParameterException(ParameterException):
    """The name of a parameter is empty or malformed."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("invalid parameter name", parameter_name)


class InvalidParameterTypeException(ParameterException):
    """The value's type differs from the declared type."""

    def __init__(self, desired_parameter: Any, expected_type: str) -> None:
        super().__init__(
            f"parameter {desired_parameter.name!r} got {desired_parameter.value!r} "
            f"({desired_parameter.type_.name}), expected {expected_type}",
            desired_parameter.name,
        )


class OverrideTypeError(InvalidParameterTypeException):
    """A parameter file or the command line gives a value of another type."""

    def __init__(self, text: str, name: str) -> None:
        ParameterError.__init__(self, text)
        self.parameters = name


class InvalidParameterValueException(ParameterException):
    """The descriptor or a callback rejects the value."""

    def __init__(self, parameter: str, value: Any, reason: str) -> None:
        super().__init__(
            f"parameter {parameter!r} cannot be {value!r}: {reason}", parameter
        )


class ParameterImmutableException(ParameterException):
    """A read-only parameter cannot be undeclared or changed."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("parameter is read-only", parameter_name)


class ParameterUninitializedException(ParameterException):
    """A statically typed parameter was read before it had a value."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("parameter has no value yet", parameter_name)
