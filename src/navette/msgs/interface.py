"""Interface definitions: fields, constants, messages, services and actions."""

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

# The member of a message without fields when serialised (C has no empty struct).
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
        """Whether the base is a message."""
        return "/" in self.base

    @property
    def is_string(self) -> bool:
        """Whether the base is ``string`` or ``wstring``."""
        return self.base in STRINGS

    @property
    def is_numeric(self) -> bool:
        """Whether the base is a number; a char is one, bool and byte are not.

        Fixed-size arrays of numbers are numpy arrays, sequences ``array.array``.
        """
        return self.base in INTEGER_RANGES or self.base in FLOATS

    @property
    def is_scalar(self) -> bool:
        """Whether the field is a single value."""
        return self.container == "scalar"

    def __str__(self) -> str:
        """The type as in a definition file; messages as ``pkg/Name``."""
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
    """A field; ``default`` is None if the definition gives none."""

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
    """A message, or a part of a service or action."""

    name: str
    fields: tuple[Field, ...] = ()
    constants: tuple[Constant, ...] = ()

    @property
    def wire_fields(self) -> tuple[Field, ...]:
        """The fields that are serialised and hashed; at least one."""
        return self.fields or (Field(PLACEHOLDER, FieldType("uint8")),)


@dataclass(frozen=True)
class ServiceSpec:
    """A service: request, response, and the event message for introspection."""

    name: str
    request: MessageSpec
    response: MessageSpec
    event: MessageSpec

    def parts(self) -> Iterator[MessageSpec]:
        """All messages of the service."""
        yield from (self.request, self.response, self.event)


@dataclass(frozen=True)
class ActionSpec:
    """An action: goal, result, feedback, and the services and messages around them."""

    name: str
    goal: MessageSpec
    result: MessageSpec
    feedback: MessageSpec
    send_goal: ServiceSpec
    get_result: ServiceSpec
    feedback_message: MessageSpec

    def parts(self) -> Iterator[MessageSpec]:
        """All messages of the action."""
        yield from (self.goal, self.result, self.feedback)
        yield from self.send_goal.parts()
        yield from self.get_result.parts()
        yield self.feedback_message


Spec = MessageSpec | ServiceSpec | ActionSpec


_TIME = FieldType("builtin_interfaces/msg/Time")
_GOAL_ID = Field("goal_id", FieldType("unique_identifier_msgs/msg/UUID"))
_EVENT_INFO = Field("info", FieldType("service_msgs/msg/ServiceEventInfo"))


def make_service(name: str, request: MessageSpec, response: MessageSpec) -> ServiceSpec:
    """Return the service with its event message, as rosidl expands it."""
    event = MessageSpec(
        f"{name}_Event",
        (
            _EVENT_INFO,
            Field("request", FieldType(request.name, "sequence", 1)),
            Field("response", FieldType(response.name, "sequence", 1)),
        ),
    )
    return ServiceSpec(name, request, response, event)


def make_action(
    name: str, goal: MessageSpec, result: MessageSpec, feedback: MessageSpec
) -> ActionSpec:
    """Return the action with its services and messages, as rosidl expands it."""
    send_goal = make_service(
        f"{name}_SendGoal",
        MessageSpec(
            f"{name}_SendGoal_Request",
            (_GOAL_ID, Field("goal", FieldType(goal.name))),
        ),
        MessageSpec(
            f"{name}_SendGoal_Response",
            (Field("accepted", FieldType("bool")), Field("stamp", _TIME)),
        ),
    )
    get_result = make_service(
        f"{name}_GetResult",
        MessageSpec(f"{name}_GetResult_Request", (_GOAL_ID,)),
        MessageSpec(
            f"{name}_GetResult_Response",
            (
                Field("status", FieldType("int8")),
                Field("result", FieldType(result.name)),
            ),
        ),
    )
    feedback_message = MessageSpec(
        f"{name}_FeedbackMessage",
        (_GOAL_ID, Field("feedback", FieldType(feedback.name))),
    )
    return ActionSpec(
        name, goal, result, feedback, send_goal, get_result, feedback_message
    )


def short_name(name: str) -> str:
    """``geometry_msgs/msg/Point`` → ``geometry_msgs/Point``."""
    package, _, rest = name.partition("/")
    return f"{package}/{rest.rpartition('/')[2]}"
