"""Checks of interface classes that programs pass in."""

from typing import Any, TypeVar

from navette.errors import MessageError, UnknownNameError
from navette.msgs import Message, type_name

# rclpy's names for annotations.
Msg = Message
MsgT = TypeVar("MsgT")
SrvT = TypeVar("SrvT")
SrvRequestT = TypeVar("SrvRequestT")
SrvResponseT = TypeVar("SrvResponseT")
SrvEventT = TypeVar("SrvEventT")

_KINDS = {"msg": "a message", "srv": "a service", "action": "an action"}


class NoTypeSupportImportedException(  # noqa: N818 - rclpy's name
    MessageError, RuntimeError, AttributeError
):
    """The class is not an interface, or not of the expected kind."""


def interface_name(cls: Any, kind: str) -> str:
    """Return the name of an interface class, such as ``std_srvs/srv/Trigger``.

    Args:
        kind: ``msg``, ``srv`` or ``action``.

    Raises:
        NoTypeSupportImportedException: the class is not an interface of that kind.
    """
    wanted = _KINDS[kind]
    if not isinstance(cls, type):
        raise NoTypeSupportImportedException(
            f"expected {wanted} class, got {cls!r}, which is not a class"
        )
    try:
        name = type_name(cls)
    except UnknownNameError:
        raise NoTypeSupportImportedException(
            f"expected {wanted} class, got {cls!r}, which is not a ROS 2 interface"
        ) from None
    found = _kind(cls)
    if found != kind:
        raise NoTypeSupportImportedException(
            f"expected {wanted} class, got {name}, which is {_KINDS[found]}"
        )
    return name


def check_type(message: Any, expected: Any, sender: str) -> None:
    """Raise MessageError unless ``message`` is an instance of ``expected``.

    Args:
        sender: topic, service or action, for the error message.
    """
    if not isinstance(message, expected):
        raise MessageError(
            f"{sender}: expected {type_name(expected)}, got {type(message).__name__}"
        )


def _kind(cls: type) -> str:
    # The name does not help: an action's services are named pkg/action/Name_SendGoal.
    if hasattr(cls, "_spec_"):
        return "msg"
    return "srv" if hasattr(cls, "Request") else "action"


def check_for_type_support(msg_or_srv_type: Any) -> None:
    """Raise NoTypeSupportImportedException unless the class is an interface."""
    if getattr(msg_or_srv_type, "_type_name_", None) is None:
        raise NoTypeSupportImportedException(
            f"{msg_or_srv_type!r} is not a ROS 2 message, service or action class"
        )


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Raise NoTypeSupportImportedException unless the class is a message."""
    interface_name(msg_type, "msg")


def check_is_valid_srv_type(srv_type: Any) -> None:
    """Raise NoTypeSupportImportedException unless the class is a service."""
    interface_name(srv_type, "srv")


def check_is_valid_action_type(action_type: Any) -> None:
    """Raise NoTypeSupportImportedException unless the class is an action."""
    interface_name(action_type, "action")
