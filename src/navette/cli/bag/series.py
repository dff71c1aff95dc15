"""Read the series of numbers that ``navette bag plot`` draws."""

import math
import re
from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from navette.bags import BagReader, BagTopic
from navette.bags.bag import OnDamage
from navette.bags.message_types import Decoder
from navette.errors import InvalidValueError, MessageError, UnknownNameError
from navette.geometry import yaw_of
from navette.msgs.field_path import FieldPath, parse_field_path

_STAMPS = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")
_QUATERNION = "geometry_msgs/msg/Quaternion"
_NOT_NUMBERS = ("string", "wstring", "byte")
_FORM = "is not TOPIC.FIELD, or TOPIC.FIELD:FIELD for one over the other"
# A colon outside of brackets.
_PAIR = re.compile(r":(?![^\[]*\])")


@dataclass(frozen=True)
class PlotField:
    """A field to plot over time, or over another field."""

    text: str
    topic: str
    y: str
    x: str = ""
    """"" = time"""

    @classmethod
    def read(cls, text: str) -> "PlotField":
        """Parse ``/odom.pose.pose.position.x``, or ``….x:y`` for y over x.

        After the colon follows a field of the same message as the first one, or a path
        with dots from the top.

        Raises:
            InvalidValueError: malformed text.
        """
        topic, dot, rest = text.partition(".")
        first, *more = _PAIR.split(rest)
        if not topic or not dot or not first or len(more) > 1 or "" in more:
            raise InvalidValueError(f"{text[:100]!r} {_FORM}")
        topic = topic if topic.startswith("/") else f"/{topic}"
        if not more:
            return cls(text, topic, first)
        second, folder = more[0], first.rpartition(".")[0]
        if "." not in second and folder:
            second = f"{folder}.{second}"
        return cls(text, topic, second, first)


@dataclass
class Series:
    """A line of a plot; ``x`` is the time in seconds since the start, or a field."""

    selected: PlotField
    x: "array[float]" = field(default_factory=lambda: array("d"))
    y: "array[float]" = field(default_factory=lambda: array("d"))
    note: str = ""
    """Quantity and unit of converted values."""


def read_series(
    reader: BagReader, selected: Sequence[PlotField], on_damage: OnDamage | None = None
) -> list[Series]:
    """Read one series for each argument, in order of the stamps.

    Stamps and durations are in seconds; a quaternion becomes its unwrapped yaw in
    radians. If a sequence of a message is too short, the value is NaN.

    Raises:
        UnknownNameError: unknown topic; the message lists the known ones.
        MessageError: unknown field, or not a number.
        InvalidValueError: no messages.
    """
    known = sorted({topic.name for topic in reader.topics})
    for name in (each.topic for each in selected):
        if name not in known:
            raise UnknownNameError.of("topic", name, known)
    series = [Series(each) for each in selected]
    start_ns, pickers = reader.start_ns, dict[BagTopic, _Picker]()
    topics = {each.topic for each in selected}
    for message in reader.messages(topics, on_damage=on_damage):
        picker = pickers.get(message.topic)
        if picker is None:
            picker = pickers[message.topic] = _Picker(message.topic, series)
        picker.add(message.data, (message.stamp_ns - start_ns) * 1e-9)
    for line in series:
        if not line.x:
            raise InvalidValueError(f"{line.selected.text}: no messages on that topic")
    return series


class _Picker:
    """Append values of a topic's messages to the series."""

    def __init__(self, topic: BagTopic, series: Sequence[Series]) -> None:
        self._decode = Decoder(topic)
        type_name = self._decode.message_class._type_name_
        self._lines = [
            (
                each,
                _Number(each.selected.x, type_name) if each.selected.x else None,
                _Number(each.selected.y, type_name),
            )
            for each in series
            if each.selected.topic == topic.name
        ]
        for each, _, y in self._lines:
            each.note = y.note

    def add(self, data: bytes, time_s: float) -> None:
        message = self._decode(data)
        for series, x, y in self._lines:
            series.x.append(time_s if x is None else x.of(message))
            series.y.append(y.of(message))


class _Number:
    """Convert a field to a number."""

    def __init__(self, text: str, type_name: str) -> None:
        self._path: FieldPath = parse_field_path(text, type_name)
        kind = self._path.type
        self._base = kind.base
        self.note = {_QUATERNION: "yaw, rad"}.get(kind.base, "")
        self._yaw = 0.0
        if not kind.is_scalar:
            raise MessageError(
                f"field {text!r}: {kind} is an array; add an index, as in [0]"
            )
        if kind.is_message and kind.base not in (*_STAMPS, _QUATERNION):
            raise MessageError(
                f"field {text!r}: {kind} is not a number; select one of its fields"
            )
        if kind.is_string or kind.base in _NOT_NUMBERS:
            raise MessageError(f"field {text!r}: {kind} is not a number")

    def of(self, message: Any) -> float:
        try:
            value = self._path.of(message)
        except IndexError:
            return math.nan
        if self._base in _STAMPS:
            return float(value.sec + value.nanosec * 1e-9)
        if self._base == _QUATERNION:
            yaw = yaw_of((value.x, value.y, value.z, value.w))
            self._yaw += math.remainder(yaw - self._yaw, math.tau)
            return self._yaw
        return float(value)
