"""Differences between two messages of one type, field by field."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from navette.bags.compare.tolerance import Tolerance
from navette.msgs import Message, fields

_NS_PER_S = 1_000_000_000
_TIME = ["sec", "nanosec"]
_LONGEST_SHOWN = 60


@dataclass(frozen=True)
class FieldDifference:
    """A field of a message that differs by more than its tolerance.

    ``largest`` is the largest difference of numbers; None for text, lengths and NaN.
    Times are compared in seconds.
    """

    path: str
    differing: int
    elements: int
    largest: float | None
    expected: str
    got: str

    @property
    def size(self) -> float:
        return math.inf if self.largest is None else self.largest


ToleranceOf = Callable[[str], Tolerance]


def message_differences(
    expected: Message, got: Message, tolerance_of: ToleranceOf
) -> list[FieldDifference]:
    """Return all fields that exceed their tolerance; paths have no indices."""
    found: list[FieldDifference] = []
    _compare(expected, got, "", tolerance_of, found)
    return found


def _compare(
    a: Any, b: Any, path: str, tolerance_of: ToleranceOf, found: list[FieldDifference]
) -> None:
    if isinstance(a, Message):
        _compare_messages(a, b, path, tolerance_of, found)
    elif isinstance(a, str | bytes | bool):
        if b not in (a, tolerance_of(path).stand_in or a):
            found.append(_plain(path, a, b))
    elif isinstance(a, int | float):
        _compare_numbers([a], [b], path, tolerance_of(path), found)
    else:
        _compare_sequences(a, b, path, tolerance_of, found)


def _compare_messages(
    a: Any, b: Any, path: str, tolerance_of: ToleranceOf, found: list[FieldDifference]
) -> None:
    names = [each.name for each in fields(a)]
    if names == _TIME:
        # Subtract nanoseconds first: seconds since 1970 would lose precision.
        apart_ns = (b.sec - a.sec) * _NS_PER_S + b.nanosec - a.nanosec
        if abs(apart_ns) > tolerance_of(path).absolute * _NS_PER_S:
            one, other = (f"{t.sec}.{t.nanosec:09d} s" for t in (a, b))
            distance_s = abs(apart_ns) / _NS_PER_S
            found.append(FieldDifference(path, 1, 1, distance_s, one, other))
        return
    prefix = f"{path}." if path else ""
    for name in names:
        _compare(getattr(a, name), getattr(b, name), prefix + name, tolerance_of, found)


def _compare_sequences(
    a: Sequence[Any],
    b: Sequence[Any],
    path: str,
    tolerance_of: ToleranceOf,
    found: list[FieldDifference],
) -> None:
    path += "[]"
    if len(a) != len(b):
        texts = f"{len(a)} elements", f"{len(b)} elements"
        elements = max(len(a), len(b))
        count = abs(len(a) - len(b))
        found.append(FieldDifference(path, count, elements, None, *texts))
    elif len(a) and isinstance(a[0], int | float | np.number | np.bool_):
        _compare_numbers(a, b, path, tolerance_of(path), found)
    else:
        single: list[FieldDifference] = []
        for one, other in zip(a, b, strict=True):
            _compare(one, other, path, tolerance_of, single)
        found += _joined(single, len(a))


def _compare_numbers(
    a: Sequence[Any],
    b: Sequence[Any],
    path: str,
    tolerance: Tolerance,
    found: list[FieldDifference],
) -> None:
    one, other = np.asarray(a), np.asarray(b)
    same = one == other
    if same.all():
        return
    are_whole = one.dtype.kind in "iu" and other.dtype.kind in "iu"
    # As floats, whole numbers above 2⁵³ that differ are equal.
    number = object if are_whole and one.dtype.itemsize == 8 else float
    x, y = one.astype(number), other.astype(number)
    same |= (x != x) & (y != y)  # NaN
    with np.errstate(invalid="ignore"):
        apart = np.abs(y - x).astype(float)
    shown = "d" if are_whole else ".9g"
    # Infinite numbers and NaN have no distance: they are equal or different.
    beyond = ~same & ~(apart <= tolerance.absolute)
    count = int(beyond.sum())
    if count == 0 or count <= tolerance.share * len(one):
        return
    worst = int(np.argmax(np.where(beyond, np.nan_to_num(apart, nan=math.inf), -1.0)))
    largest = float(apart[worst])
    found.append(
        FieldDifference(
            path,
            count,
            len(one),
            largest if math.isfinite(largest) else None,
            f"{one[worst]:{shown}}",
            f"{other[worst]:{shown}}",
        )
    )


def _plain(path: str, a: object, b: object) -> FieldDifference:
    return FieldDifference(path, 1, 1, None, _shown(a), _shown(b))


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _LONGEST_SHOWN else f"{text[: _LONGEST_SHOWN - 1]}…"


def _joined(single: list[FieldDifference], count: int) -> list[FieldDifference]:
    """Merge the differences of all elements of a field, with the worst as example."""
    worst: dict[str, FieldDifference] = {}
    for each in single:
        before = worst.get(each.path)
        if before is None:
            worst[each.path] = replace(each, elements=each.elements * count)
            continue
        shown = each if each.size > before.size else before
        worst[each.path] = replace(
            shown,
            differing=before.differing + each.differing,
            elements=before.elements,
        )
    return list(worst.values())
