"""Type-correct messages with extreme contents, for any message type.

The fields of a message are found from its definition, so a type needs no table. Every
value can be assigned to its field: what is wrong with it is its meaning.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple, TypeVar

import numpy as np

from navette.msgs import Message, fields, get_interface, serialize
from navette.msgs.copying import copy_message
from navette.msgs.interface import FLOATS, INTEGER_RANGES, FieldType
from navette.msgs.values import FLOAT32_MAX

M = TypeVar("M", bound=Message)

_LARGEST = {"float32": FLOAT32_MAX, "float64": 1.7976931348623157e308}
_DENORMAL = {"float32": 1.401298464324817e-45, "float64": 5e-324}
_STRINGS = (
    "",
    "\0",
    "map\0",
    "nowhere",
    "/",
    "/map",
    "a" * 10_000,
    "../../etc/passwd",
    "\x1b]0;title\x07\x1b[31mred\x1b[2J",
    "\n" * 50,
    "%s%n{0}{}",
    "地図😀",
    "\ufeff\u202e",
)
_COUNTS = (0, 1, 2, 3, 7, 1000, 20_000)
_MOST_MESSAGES = 1000


class Place(NamedTuple):
    """A field of a message or of a part of it."""

    owner: Message
    name: str
    type: FieldType
    path: str


def places(msg: Message, path: str = "") -> Iterator[Place]:
    """Yield every field of a message, of its parts and of elements of its lists."""
    for field in fields(msg):
        here = f"{path}.{field.name}" if path else field.name
        yield Place(msg, field.name, field.type, here)
        value = getattr(msg, field.name)
        if not field.type.is_message:
            continue
        parts = [value] if field.type.is_scalar else value
        for index in {0, len(parts) // 2, len(parts) - 1} & set(range(len(parts))):
            inner = here if field.type.is_scalar else f"{here}[{index}]"
            yield from places(parts[index], inner)


class Extremes:
    """Draws extreme messages; the same seed draws the same ones.

    Args:
        seed: of the random numbers.
    """

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng(seed)

    def spoiled(self, valid: M, *, most: int = 4) -> tuple[M, str]:
        """Return a copy with one extreme field, at times several, and their paths."""
        msg = copy_message(valid)
        count = 1 if self.rng.random() < 0.7 else int(self.rng.integers(2, most + 1))
        changed = []
        for _ in range(count):
            found = list(places(msg))
            if not found:
                break
            place = found[int(self.rng.integers(len(found)))]
            setattr(place.owner, place.name, self.value(place.type, place))
            changed.append(place.path)
        return msg, ", ".join(changed)

    def spoiled_bytes(self, valid: Message) -> tuple[bytes, str]:
        """Return the serialized message with damaged bytes, and what was done."""
        data = bytearray(serialize(valid))
        kind = int(self.rng.integers(4))
        if kind == 0:
            cut = int(self.rng.integers(len(data)))
            return bytes(data[:cut]), f"cut to {cut} of {len(data)} bytes"
        if kind == 1:
            extra = self.rng.bytes(int(self.rng.integers(1, 64)))
            return bytes(data) + extra, "bytes appended"
        at = int(self.rng.integers(4, max(5, len(data))))
        size = 4 if kind == 2 else int(self.rng.integers(1, 16))
        data[at : at + size] = b"\xff" * size if kind == 2 else self.rng.bytes(size)
        return bytes(data), f"{size} bytes overwritten at {at}"

    def message(self, cls: type[M]) -> M:
        """Return a message of which every field is extreme."""
        return cls(**{field.name: self.value(field.type) for field in fields(cls)})

    def value(self, type_: FieldType, place: Place | None = None) -> Any:
        """Return an extreme value of a field."""
        if type_.is_scalar:
            return self._scalar(type_)
        current = getattr(place.owner, place.name) if place is not None else ()
        count = self._count(type_, len(current))
        if type_.is_numeric:
            return self._numbers(type_, count)
        if type_.is_message:
            cls = get_interface(type_.base)
            first = self.message(cls) if count else None
            return [first] * min(count, _MOST_MESSAGES) if first else []
        return [self._scalar(type_) for _ in range(min(count, _MOST_MESSAGES))]

    def _count(self, type_: FieldType, current: int) -> int:
        if type_.container == "array":
            return type_.size or 0
        near = (current - 1, current + 1, 2 * current)
        counts = [each for each in (*_COUNTS, *near) if each >= 0]
        count = counts[int(self.rng.integers(len(counts)))]
        return count if type_.size is None else min(count, type_.size)

    def _numbers(self, type_: FieldType, count: int) -> np.ndarray[Any, Any]:
        element = FieldType(type_.base)
        drawn = [self._scalar(element) for _ in range(min(count, 8))] or [0]
        numbers = np.resize(np.array(drawn), count)
        if type_.base in INTEGER_RANGES:
            return np.resize(np.array(drawn, np.dtype(_dtype(type_.base))), count)
        return numbers.astype(_dtype(type_.base))

    def _scalar(self, type_: FieldType) -> Any:
        if type_.is_message:
            return self.message(get_interface(type_.base))
        if type_.is_string:
            text = self._one_of(_STRINGS)
            return text if type_.string_bound is None else text[: type_.string_bound]
        if type_.base in INTEGER_RANGES:
            low, high = INTEGER_RANGES[type_.base]
            usual = (low, high, low + 1, high - 1, 0, 1, -1, 10**9 - 1, 10**9, 16)
            return self._one_of([each for each in usual if low <= each <= high])
        if type_.base in FLOATS:
            return self._float(type_.base)
        if type_.base == "bool":
            return bool(self.rng.integers(2))
        return bytes([int(self.rng.integers(256))])

    def _float(self, base: str) -> float:
        largest, denormal = _LARGEST[base], _DENORMAL[base]
        huge = 1e308 if base == "float64" else 1e38
        values = (
            *(float("nan"), float("inf"), -float("inf")),
            *(largest, -largest, huge, -huge, denormal, -denormal),
            *(0.0, -0.0, 1.0, -1.0, 1e9, -1e9, 1e10, 1e15, -1e15, 1e-9, 1e5, 0.5),
        )
        value = float(self._one_of(values))
        return float(np.float32(value)) if base == "float32" else value

    def _one_of(self, values: Any) -> Any:
        return values[int(self.rng.integers(len(values)))]


def _dtype(base: str) -> str:
    return "u1" if base == "char" else base


def unusable_numbers(msg: Message) -> list[str]:
    """Return the paths of floats of a message that are not finite."""
    return [
        place.path
        for place in places(msg)
        if place.type.base in FLOATS
        and not np.all(np.isfinite(getattr(place.owner, place.name)))
    ]
