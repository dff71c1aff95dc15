"""Types of fields as ROS 2's ``rosidl_parser.definition`` names them."""

from dataclasses import dataclass
from typing import Any

from navette.msgs.interface import FieldType, MessageSpec

#: Name in a definition → name in IDL, where they differ.
IDL_NAMES = {"bool": "boolean", "byte": "octet", "char": "uint8"}
IDL_NAMES |= {"float32": "float", "float64": "double"}


class AbstractType:
    """Base of all types."""


class AbstractNestableType(AbstractType):
    """Type that arrays and sequences may contain."""


@dataclass(frozen=True)
class BasicType(AbstractNestableType):
    """A number, ``boolean`` or ``octet``."""

    typename: str


@dataclass(frozen=True)
class NamedType(AbstractNestableType):
    """Type known by its name."""

    name: str


@dataclass(frozen=True, init=False)
class NamespacedType(AbstractNestableType):
    """A message: ``namespaces`` (``('std_msgs', 'msg')``) and ``name``."""

    namespaces: tuple[str, ...]
    name: str

    def __init__(self, namespaces: Any, name: str) -> None:
        object.__setattr__(self, "namespaces", tuple(namespaces))
        object.__setattr__(self, "name", name)

    def namespaced_name(self) -> tuple[str, ...]:
        return (*self.namespaces, self.name)


class AbstractGenericString(AbstractNestableType):
    """Base of all texts."""

    def has_maximum_size(self) -> bool:
        return isinstance(self, (BoundedString, BoundedWString))


class AbstractString(AbstractGenericString):
    """Base of texts of 8-bit characters."""


class AbstractWString(AbstractGenericString):
    """Base of texts of wide characters."""


@dataclass(frozen=True)
class BoundedString(AbstractString):
    """``string<=N``."""

    maximum_size: int


@dataclass(frozen=True)
class UnboundedString(AbstractString):
    """``string``."""


@dataclass(frozen=True)
class BoundedWString(AbstractWString):
    """``wstring<=N``."""

    maximum_size: int


@dataclass(frozen=True)
class UnboundedWString(AbstractWString):
    """``wstring``."""


@dataclass(frozen=True)
class AbstractNestedType(AbstractType):
    """Base of arrays and sequences; ``value_type`` is the type of their items."""

    value_type: AbstractNestableType


@dataclass(frozen=True)
class Array(AbstractNestedType):
    """``type[N]``."""

    size: int

    def has_maximum_size(self) -> bool:
        return True


class AbstractSequence(AbstractNestedType):
    """Base of sequences."""

    def has_maximum_size(self) -> bool:
        return isinstance(self, BoundedSequence)


@dataclass(frozen=True)
class BoundedSequence(AbstractSequence):
    """``type[<=N]``."""

    maximum_size: int


@dataclass(frozen=True)
class UnboundedSequence(AbstractSequence):
    """``type[]``."""


def slot_type(field: FieldType) -> AbstractType:
    """Return the type of a field."""
    item = _item_type(field)
    if field.container == "array":
        return Array(item, field.size or 0)
    if field.container == "sequence":
        if field.size is None:
            return UnboundedSequence(item)
        return BoundedSequence(item, field.size)
    return item


def _item_type(field: FieldType) -> AbstractNestableType:
    if field.is_message:
        *namespaces, name = field.base.split("/")
        return NamespacedType(namespaces, name)
    if not field.is_string:
        return BasicType(IDL_NAMES.get(field.base, field.base))
    bound, is_wide = field.string_bound, field.base == "wstring"
    if bound is None:
        return UnboundedWString() if is_wide else UnboundedString()
    return BoundedWString(bound) if is_wide else BoundedString(bound)


class SlotTypes:
    """Attribute ``SLOT_TYPES`` of a message class, made when it is read."""

    def __get__(self, message: Any, cls: Any) -> tuple[AbstractType, ...]:
        spec: MessageSpec = cls._spec_
        return tuple(slot_type(field.type) for field in spec.fields)
