"""What an interface definition says: fields, constants, three kinds of interface."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

INTEGER_RANGES: dict[str, tuple[int, int]] = {
    "int8": (-(2**7), 2**7 - 1),
    "uint8": (0, 2**8 - 1),
    "char": (0, 2**8 - 1),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
}
FLOATS = ("float32", "float64")
STRINGS = ("string", "wstring")
PRIMITIVES = (*INTEGER_RANGES, *FLOATS, *STRINGS, "bool", "byte")

# The one member that an empty definition gets on the wire (C has no empty struct).
PLACEHOLDER = "structure_needs_at_least_one_member"

Default = bool | int | float | str | bytes | list[bool | int | float | str]


@dataclass(frozen=True)
class FieldType:
    """Type of a field: ``base`` alone, ``base[size]``, ``base[]`` or ``base[<=size]``.

    ``base`` is a primitive's name in the definition language or a full message name
    (``geometry_msgs/msg/Point``).
    """

    base: str
    container: Literal["scalar", "array", "sequence"] = "scalar"
    size: int | None = None
    string_bound: int | None = None

    @property
    def is_message(self) -> bool:
        """Whether the base is another message."""
        return "/" in self.base

    @property
    def is_string(self) -> bool:
        """Whether the base is ``string`` or ``wstring``."""
        return self.base in STRINGS

    @property
    def is_numeric(self) -> bool:
        """Whether the base is a number (a char is one, bool and byte are none).

        Fixed-size arrays of numbers are numpy arrays, sequences ``array.array``.
        """
        return self.base in INTEGER_RANGES or self.base in FLOATS

    @property
    def is_scalar(self) -> bool:
        """Whether the field holds one value, no array."""
        return self.container == "scalar"

    def __str__(self) -> str:
        """As written in a definition file; messages as ``pkg/Name``."""
        base = short_name(self.base) if self.is_message else self.base
        if self.string_bound is not None:
            base += f"<={self.string_bound}"
        if self.container == "array":
            return f"{base}[{self.size}]"
        if self.container == "sequence":
            return f"{base}[]" if self.size is None else f"{base}[<={self.size}]"
        return base


@dataclass(frozen=True)
class Field:
    """A field; ``default`` is None where the definition gives none."""

    name: str
    type: FieldType
    default: Default | None = None


@dataclass(frozen=True)
class Constant:
    """A named value of a definition."""

    name: str
    base: str
    value: bool | int | float | str | bytes


@dataclass(frozen=True)
class MessageSpec:
    """A message, also each part of a service or an action."""

    name: str
    fields: tuple[Field, ...] = ()
    constants: tuple[Constant, ...] = ()

    @property
    def wire_fields(self) -> tuple[Field, ...]:
        """The fields that are serialised and hashed: never none."""
        return self.fields or (Field(PLACEHOLDER, FieldType("uint8")),)


@dataclass(frozen=True)
class ServiceSpec:
    """A service: request and response (the event is made from the two)."""

    name: str
    request: MessageSpec
    response: MessageSpec
    event: MessageSpec

    def parts(self) -> Iterator[MessageSpec]:
        """Every message that belongs to the service."""
        yield from (self.request, self.response, self.event)


@dataclass(frozen=True)
class ActionSpec:
    """An action: goal, result, feedback and what its protocol sends."""

    name: str
    goal: MessageSpec
    result: MessageSpec
    feedback: MessageSpec
    send_goal: ServiceSpec
    get_result: ServiceSpec
    feedback_message: MessageSpec

    def parts(self) -> Iterator[MessageSpec]:
        """Every message that belongs to the action."""
        yield from (self.goal, self.result, self.feedback)
        yield from self.send_goal.parts()
        yield from self.get_result.parts()
        yield self.feedback_message


Spec = MessageSpec | ServiceSpec | ActionSpec


def short_name(name: str) -> str:
    """``geometry_msgs/msg/Point`` → ``geometry_msgs/Point``."""
    package, _, rest = name.partition("/")
    return f"{package}/{rest.rpartition('/')[2]}"
