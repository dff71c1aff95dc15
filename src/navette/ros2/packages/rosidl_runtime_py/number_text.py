"""Fast YAML text of large arrays of numbers.

A YAML emitter needs some microseconds per number, and an image has millions. So
:mod:`.yaml_text` lets the emitter write a placeholder for each array, which the
functions here replace.
"""

import re
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

CUT = "..."
"""The last item of a shortened array."""

_UNSIGNED = [str(number) for number in range(256)]
# Indexed by the unsigned byte.
_SIGNED = [str(number) for number in (*range(128), *range(-128, 0))]
# A float in YAML requires a point: 1e-05 would be a text.
_NO_POINT = re.compile(r"(?<![\d.])(\d+)e")


@dataclass(frozen=True, slots=True, eq=False)
class Numbers:
    """Sequence of numbers or bools of a message; ``is_cut`` if it is shortened."""

    items: "np.ndarray[Any, Any] | array[Any] | list[bool]"
    is_cut: bool = False

    def plain(self) -> list[Any]:
        """Return a list, which ends in :data:`CUT` if it is shortened."""
        items = self.items if isinstance(self.items, list) else self.items.tolist()
        return [*items, CUT] if self.is_cut else items


@dataclass(frozen=True, slots=True)
class Layout:
    """Layout of arrays in a text.

    Args:
        flow: the whole text on one line, arrays in brackets.
        width: arrays in brackets, in lines of at most this many characters, for a
            terminal; None: one item per line.
    """

    flow: bool = False
    width: int | None = None


def with_numbers(
    around: Sequence[str], arrays: Sequence[Numbers], layout: Layout
) -> Iterator[str]:
    """Yield alternately the text around the arrays and an array."""
    for numbers, before in zip(arrays, around, strict=False):
        line = before[before.rfind("\n") + 1 :]
        if layout.flow:
            yield from (before, f"[{_joined(numbers, ', ')}]")
        elif layout.width is not None:
            yield from (before, _in_rows(numbers, len(line) + 1, layout.width))
        else:
            indent = len(line) - len(line.lstrip(" -"))
            item = f"\n{' ' * indent}- "
            text = item + _joined(numbers, item)
            yield from (before.rstrip(" "), text if line else text[1:])
    yield around[-1]


def _in_rows(numbers: Numbers, indent: int, width: int) -> str:
    """Return the numbers in brackets, with line breaks between them."""
    room = max(width - indent - 1, 1)
    rows = re.compile(rf"(.{{1,{room}}}|\S+)(?:, |\Z)")
    between = f",\n{' ' * indent}"
    text = rows.sub(rf"\1{between}", _joined(numbers, ", "))
    return f"[{text.removesuffix(between)}]"


def _joined(numbers: Numbers, between: str) -> str:
    end = f"{between}'{CUT}'" if numbers.is_cut else ""
    return _yaml_words(np.asarray(numbers.items), between) + end


def _yaml_words(values: "np.ndarray[Any, Any]", between: str) -> str:
    text = python_words(values, between)
    if values.dtype.kind == "b":
        text = text.lower()
    elif values.dtype.kind == "f":
        text = text.replace("nan", ".nan").replace("inf", ".inf")
        text = _NO_POINT.sub(r"\1.0e", text)
    return text


def python_words(values: "np.ndarray[Any, Any]", between: str) -> str:
    """Return the numbers as Python formats them."""
    kind = values.dtype.kind
    if kind in "iu" and values.itemsize == 1:
        words = _UNSIGNED if kind == "u" else _SIGNED
        return between.join(map(words.__getitem__, values.tobytes()))
    return str(values.tolist())[1:-1].replace(", ", between)
