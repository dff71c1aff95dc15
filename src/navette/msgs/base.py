"""Base class of all message classes."""

from array import array
from collections.abc import Callable
from typing import Any, ClassVar, Never, Self

import numpy as np

from navette.errors import MessageError
from navette.msgs.interface import Field, FieldType, MessageSpec, short_name
from navette.msgs.slot_types import SlotTypes


class _Default:
    """Default of the arguments of generated constructors."""

    def __repr__(self) -> str:
        return "<default>"


DEFAULT = _Default()


class Message:
    """Base of every generated message class.

    A class has a slot ``_name`` and a checked property ``name`` for each field, its
    constants as attributes, and its definition as ``_spec_``. Names such as ``_spec_``
    end in an underscore because field names cannot.
    """

    __slots__ = ()

    _spec_: ClassVar[MessageSpec]
    _type_name_: ClassVar[str]
    _field_types_: ClassVar[dict[str, str]]
    _make_default_: ClassVar[Callable[[], Any]]
    SLOT_TYPES = SlotTypes()

    __hash__ = None  # type: ignore[assignment]

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Types by field name, spelled as in rclpy."""
        return dict(cls._field_types_)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Message) or self._type_name_ != other._type_name_:
            return NotImplemented
        return all(
            _equal(getattr(self, name), getattr(other, name))
            for name in self._field_types_
        )

    def __repr__(self) -> str:
        shown = (f"{name}={_show(getattr(self, name))}" for name in self._field_types_)
        package, kind, name = self._type_name_.split("/")
        return f"{package}.{kind}.{name}({', '.join(shown)})"

    def __copy__(self) -> Self:
        names = self._field_types_
        return type(self)(**{name: getattr(self, name) for name in names})


def fields(interface: "type[Message] | Message") -> tuple[Field, ...]:
    """Return the fields of a message class in order: names, types, defaults.

    Raises:
        MessageError: ``interface`` is neither a message nor a message class.
    """
    spec = getattr(interface, "_spec_", None)
    if not isinstance(spec, MessageSpec):
        raise MessageError(f"{interface!r} is neither a message nor a message class")
    return spec.fields


def validate(msg: Message) -> None:
    """Check every field, nested ones too, such as lists that were changed in place.

    Raises:
        MessageError: names the first field with an invalid value.
    """
    if not isinstance(msg, Message):
        raise MessageError(f"{msg!r} is {type(msg).__name__}, expected a message")
    for name in msg._field_types_:
        value: Any = getattr(msg, name)
        setattr(msg, name, value)
        for item in value if isinstance(value, list) else (value,):
            if isinstance(item, Message):
                validate(item)


def refuse_keywords(cls: type[Message], unknown: dict[str, Any]) -> Never:
    """Raise MessageError for constructor keywords that are not fields."""
    listed = ", ".join(cls._field_types_) or "none"
    named = ", ".join(repr(name) for name in unknown)
    raise MessageError(f"{cls._type_name_} has no field {named}; its fields: {listed}")


def _equal(mine: Any, other: Any) -> bool:
    if isinstance(mine, np.ndarray) or isinstance(other, np.ndarray):
        return np.array_equal(mine, other)
    return bool(mine == other)


def _show(value: Any) -> str:
    """Format a value as rclpy does: a sequence of numbers as a whole list."""
    return repr(value.tolist() if isinstance(value, array) else value)


_IDL_NAMES = {"float64": "double", "float32": "float", "bool": "boolean"}
_IDL_NAMES |= {"byte": "octet", "char": "uint8"}


def idl_type(type_: FieldType) -> str:
    """Spell a type as rclpy does: ``sequence<double, 3>``, ``geometry_msgs/Point``."""
    base = short_name(type_.base) if type_.is_message else type_.base
    base = _IDL_NAMES.get(base, base)
    if type_.string_bound is not None:
        base += f"<{type_.string_bound}>"
    if type_.container == "array":
        return f"{base}[{type_.size}]"
    if type_.container == "sequence":
        return (
            f"sequence<{base}>"
            if type_.size is None
            else (f"sequence<{base}, {type_.size}>")
        )
    return base
