"""rosidl_runtime_py.utilities: classes of interfaces by their names."""

from typing import Any

from navette import msgs
from navette.errors import InvalidNameError, UnknownNameError


class UnknownInterfaceError(UnknownNameError, AttributeError):
    """Nobody defines an interface of that name.

    Also an ``AttributeError``, because that is what ROS 2's functions raise.
    """


def get_interface(identifier: str) -> Any:
    """The class of ``pkg/msg/Name``, ``pkg/srv/Name`` or ``pkg/action/Name``.

    Raises:
        ValueError: the name has the wrong form.
        UnknownInterfaceError: nobody defines it; lists what the package has.
    """
    try:
        return msgs.get_interface(identifier)
    except UnknownNameError as error:
        raise UnknownInterfaceError(str(error)) from error


def get_message(identifier: str) -> Any:
    """The class of a message; ``pkg/Name`` will do.

    Raises:
        ValueError: it is no message, or the name has the wrong form.
    """
    return _of_kind(identifier, "msg", "a message")


def get_service(identifier: str) -> Any:
    """The class of a service; ``pkg/Name`` will do."""
    return _of_kind(identifier, "srv", "a service")


def get_action(identifier: str) -> Any:
    """The class of an action; ``pkg/Name`` will do."""
    return _of_kind(identifier, "action", "an action")


def is_message(interface: Any) -> bool:
    return hasattr(interface, "SLOT_TYPES")


def is_service(interface: Any) -> bool:
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: Any) -> bool:
    return all(hasattr(interface, name) for name in ("Goal", "Result", "Feedback"))


_TESTS = {"msg": is_message, "srv": is_service, "action": is_action}


def _of_kind(identifier: str, kind: str, wanted: str) -> Any:
    package, _, rest = identifier.partition("/")
    full = identifier if "/" in rest else f"{package}/{kind}/{rest}"
    interface = get_interface(full)
    if not _TESTS[kind](interface):
        raise InvalidNameError(
            f"expected the full name of {wanted}, got {identifier!r}"
        )
    return interface
