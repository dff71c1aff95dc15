"""Registries of functions that transform and convert types.

As in tf2 the registries belong to the process: a package registers its types when it is
imported.
"""

# ruff: noqa: N818, N802 - the names are tf2's

from collections.abc import Callable, Hashable
from copy import deepcopy
from typing import Any, ClassVar

from navette.errors import InvalidValueError
from navette.msgs.std_msgs.msg import Header


class TypeException(InvalidValueError):
    """The type is not registered."""

    def __init__(self, errstr: str) -> None:
        super().__init__(errstr)
        self.errstr = errstr


class NotImplementedException(NotImplementedError):
    """A buffer lacks one of the interface's methods."""

    def __init__(self) -> None:
        self.errstr = "CanTransform or LookupTransform not implemented"
        super().__init__(self.errstr)


_Converter = Callable[[Any], Any]


class TransformRegistration:
    """Registry of functions ``do_transform(object, transform_stamped)`` by type."""

    _functions: ClassVar[dict[Hashable, Callable[[Any, Any], Any]]] = {}

    def print_me(self) -> None:
        print(self._functions)  # noqa: T201 - its purpose

    def add(self, key: type, callback: Callable[[Any, Any], Any]) -> None:
        self._functions[key] = callback

    def get(self, key: type) -> Callable[[Any, Any], Any]:
        return _registered(self._functions, key, "transform")


class ConvertRegistration:
    """Registry of conversions to messages, from messages, and between types."""

    _to_msg: ClassVar[dict[Hashable, _Converter]] = {}
    _from_msg: ClassVar[dict[Hashable, _Converter]] = {}
    _convert: ClassVar[dict[Hashable, _Converter]] = {}

    def add_from_msg(self, key: type, callback: _Converter) -> None:
        self._from_msg[key] = callback

    def add_to_msg(self, key: type, callback: _Converter) -> None:
        self._to_msg[key] = callback

    def add_convert(self, key: tuple[type, type], callback: _Converter) -> None:
        self._convert[key] = callback

    def get_from_msg(self, key: type) -> _Converter:
        return _registered(self._from_msg, key, "convert from a message")

    def get_to_msg(self, key: type) -> _Converter:
        return _registered(self._to_msg, key, "convert to a message")

    def get_convert(self, key: tuple[type, type]) -> _Converter:
        return _registered(self._convert, key, "convert")


def _registered(
    table: dict[Hashable, Callable[..., Any]], key: Any, verb: str
) -> Callable[..., Any]:
    if key in table:
        return table[key]
    known = ", ".join(sorted(_type_names(each) for each in table)) or "none"
    raise TypeException(
        f"cannot {verb} a {_type_names(key)}: the type is not registered; "
        f"known: {known} (import the package that registers it)"
    )


def _type_names(key: Any) -> str:
    types = key if isinstance(key, tuple) else (key,)
    return " to ".join(getattr(each, "__name__", str(each)) for each in types)


def convert(a: Any, b_type: Any) -> Any:
    """Convert ``a`` to ``b_type`` directly or through a message.

    Raises:
        TypeException: the required conversion is not registered.
    """
    registration = ConvertRegistration()
    try:
        return registration.get_convert((type(a), b_type))(a)
    except TypeException:
        if type(a) is b_type:
            return deepcopy(a)
    to_msg = registration.get_to_msg(type(a))
    return registration.get_from_msg(b_type)(to_msg(a))


def Stamped(obj: Any, stamp: Any, frame_id: str) -> Any:
    """Set the header of ``obj``; ``stamp`` is a message or a Time."""
    stamp = stamp.to_msg() if hasattr(stamp, "to_msg") else stamp
    obj.header = Header(frame_id=frame_id, stamp=stamp)
    return obj
