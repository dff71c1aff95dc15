"""Which interface a class is, checked where a user hands one in."""

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


class NoTypeSupportImportedException(MessageError, RuntimeError):  # noqa: N818 - rclpy's
    """A class that is no interface, or not of the wanted kind."""


def interface_name(cls: Any, kind: str) -> str:
    """``std_srvs/srv/Trigger`` of a class of that kind (``msg``, ``srv``, ``action``).

    Raises:
        NoTypeSupportImportedException: it is something else; says what.
    """
    wanted = _KINDS[kind]
    if not isinstance(cls, type):
        raise NoTypeSupportImportedException(
            f"wanted {wanted} class, got {cls!r}, which is no class"
        )
    try:
        name = type_name(cls)
    except UnknownNameError:
        raise NoTypeSupportImportedException(
            f"wanted {wanted} class, got {cls!r}: it is no ROS 2 interface"
        ) from None
    found = _kind(cls)
    if found != kind:
        raise NoTypeSupportImportedException(
            f"wanted {wanted} class, got {name}, which is {_KINDS[found]}"
        )
    return name


def _kind(cls: type) -> str:
    # Not by the name: an action's services are called pkg/action/Name_SendGoal.
    if hasattr(cls, "_spec_"):
        return "msg"
    return "srv" if hasattr(cls, "Request") else "action"


def check_for_type_support(msg_or_srv_type: Any) -> None:
    """Raise unless it is an interface of any kind."""
    if getattr(msg_or_srv_type, "_type_name_", None) is None:
        raise NoTypeSupportImportedException(
            f"{msg_or_srv_type!r} is no ROS 2 message, service or action class"
        )


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Raise unless it is a message class."""
    interface_name(msg_type, "msg")


def check_is_valid_srv_type(srv_type: Any) -> None:
    """Raise unless it is a service class."""
    interface_name(srv_type, "srv")


def check_is_valid_action_type(action_type: Any) -> None:
    """Raise unless it is an action class."""
    interface_name(action_type, "action")
