"""rosidl_runtime_py.utilities: interface classes by name."""

from typing import Any

from navette import msgs
from navette.errors import InvalidNameError, UnknownNameError
from navette.msgs.slot_types import NamespacedType


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


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    """Return the NamespacedType of a message; accepts ``pkg/Name``."""
    return _namespaced(identifier, "msg")


def get_service_namespaced_type(identifier: str) -> NamespacedType:
    return _namespaced(identifier, "srv")


def get_action_namespaced_type(identifier: str) -> NamespacedType:
    return _namespaced(identifier, "action")


def _namespaced(identifier: str, kind: str) -> NamespacedType:
    parts = identifier.split("/")
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or not all(parts) or parts[1] != kind:
        raise InvalidNameError(f"{identifier!r}: expected 'package/{kind}/Name'")
    return NamespacedType(parts[:2], parts[2])


_TESTS = {"msg": is_message, "srv": is_service, "action": is_action}


def _of_kind(identifier: str, kind: str, expected: str) -> Any:
    package, _, rest = identifier.partition("/")
    full = identifier if "/" in rest else f"{package}/{kind}/{rest}"
    interface = get_interface(full)
    if not _TESTS[kind](interface):
        raise InvalidNameError(
            f"Expected the full name of {expected}, got {identifier!r}"
        )
    return interface
