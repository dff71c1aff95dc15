"""rosidl_runtime_py.set_message: set the fields of a message from a dict."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from navette.errors import MessageError
from navette.msgs import Message, get_interface
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.slot_types import (
    AbstractGenericString,
    AbstractNestedType,
    AbstractType,
    BasicType,
    NamespacedType,
)
from navette.msgs.std_msgs.msg import Header
from navette.ros2.packages.rosidl_runtime_py.convert import get_message_slot_types

Setter = Callable[[Any], None]


class UnknownFieldError(MessageError, AttributeError):
    """The message has no field of that name.

    Also an ``AttributeError``, which ROS 2's function raises.
    """


def set_message_fields(
    msg: Message,
    values: Mapping[str, Any],
    expand_header_auto: bool = False,
    expand_time_now: bool = False,
) -> list[Setter]:
    """Set the fields in ``values``, recursively.

    A nested message starts from its defaults. Texts are converted to numbers and
    numbers to texts according to the field's type.

    Args:
        expand_header_auto: accept ``auto`` for a header, which is stamped later.
        expand_time_now: accept ``now`` for a time, which is set later.

    Returns:
        Functions that set those stamps; to be called with a time message before
        publishing.

    Raises:
        UnknownFieldError: unknown field; lists the existing ones.
        MessageError: a value has the wrong type.
    """
    setters: list[Setter] = []
    filling = _Filling(expand_header_auto, expand_time_now, setters)
    filling.fill(msg, values)
    return setters


class _Filling:
    def __init__(self, header_auto: bool, time_now: bool, setters: list[Setter]):
        self._header_auto = header_auto
        self._time_now = time_now
        self._setters = setters

    def fill(self, msg: Message, values: Mapping[str, Any]) -> None:
        kind = getattr(msg, "_type_name_", type(msg).__name__)
        if not isinstance(values, Mapping):
            raise MessageError(
                f"Value {values!r} is expected to be a dictionary but is a "
                f"{type(values).__name__}"
            )
        types = get_message_slot_types(msg)
        for name, value in values.items():
            if name not in types:
                raise UnknownFieldError(
                    f"{kind} has no field {name!r}; its fields: "
                    f"{', '.join(types) or 'none'}"
                )
            if not self._is_stamped_later(msg, name, value):
                setattr(msg, name, self._converted(types[name], value))

    def _is_stamped_later(self, msg: Message, name: str, value: Any) -> bool:
        field = getattr(msg, name)
        if self._header_auto and value == "auto" and isinstance(field, Header):
            self._setters.append(partial(setattr, field, "stamp"))
            return True
        if self._time_now and value == "now" and isinstance(field, Time):
            self._setters.append(partial(setattr, msg, name))
            return True
        return False

    def _converted(self, slot: AbstractType, value: Any) -> Any:
        if isinstance(slot, NamespacedType):
            return self._message(slot, value)
        if isinstance(slot, AbstractNestedType):
            item = slot.value_type
            if isinstance(item, NamespacedType) and isinstance(value, (list, tuple)):
                return [self._message(item, each) for each in value]
            return value
        return _scalar(slot, value)

    def _message(self, slot: NamespacedType, value: Any) -> Any:
        if isinstance(value, Message):
            return value
        message: Message = get_interface("/".join(slot.namespaced_name()))()
        self.fill(message, value)
        return message


def _scalar(slot: AbstractType, value: Any) -> Any:
    if isinstance(slot, AbstractGenericString):
        return value if isinstance(value, str) else str(value)
    typename = slot.typename if isinstance(slot, BasicType) else ""
    if not isinstance(value, str) or typename in ("boolean", "octet"):
        return value
    try:
        return float(value) if typename in ("float", "double") else int(value)
    except ValueError:
        return value  # setting the field raises the error
