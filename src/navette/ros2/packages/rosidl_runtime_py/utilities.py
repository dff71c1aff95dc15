"""rosidl_runtime_py.utilities: interface classes by name."""

from typing import Any

from navette import msgs
from navette.errors import InvalidNameError, UnknownNameError


class UnknownInterfaceError(UnknownNameError, AttributeError):
    """An interface of that name does not exist.

    Also an ``AttributeError``, which ROS 2's functions raise.
    """


def get_interface(identifier: str) -> Any:
    """Return the class of ``pkg/msg/Name``, ``pkg/srv/Name`` or ``pkg/action/Name``.

    Raises:
        ValueError: the name has the wrong form.
        UnknownInterfaceError: unknown interface; lists those of the package.
    """
    try:
        return msgs.get_interface(identifier)
    except UnknownNameError as error:
        raise UnknownInterfaceError(str(error)) from error


def get_message(identifier: str) -> Any:
    """Return the class of a message; accepts ``pkg/Name``.

    Raises:
        ValueError: the interface is not a message, or the name has the wrong form.
    """
    return _of_kind(identifier, "msg", "a message")


def get_service(identifier: str) -> Any:
    return _of_kind(identifier, "srv", "a service")


def get_action(identifier: str) -> Any:
    return _of_kind(identifier, "action", "an action")


def is_message(interface: Any) -> bool:
    return hasattr(interface, "SLOT_TYPES")


def is_service(interface: Any) -> bool:
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: Any) -> bool:
    return all(hasattr(interface, name) for name in ("Goal", "Result", "Feedback"))


_TESTS = {"msg": is_message, "srv": is_service, "action": is_action}


def _of_kind(identifier: str, kind: str, expected: str) -> Any:
    package, _, rest = identifier.partition("/")
    full = identifier if "/" in rest else f"{package}/{kind}/{rest}"
    interface = get_interface(full)
    if not _TESTS[kind](interface):
        raise InvalidNameError(
            f"expected the full name of {expected}, got {identifier!r}"
        )
    return interface
