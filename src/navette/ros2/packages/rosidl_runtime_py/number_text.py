"""Arrays of numbers as YAML text, by the million.

A YAML emitter takes some microseconds a number, and an image has millions. So
:mod:`.yaml_text` lets it write a mark in the place of each array, and what stands there
is made here.
"""

import re
from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

CUT = "..."
"""The last item where an array is not shown whole."""

_UNSIGNED = [str(number) for number in range(256)]
# By the byte that stands for the number.
_SIGNED = [str(number) for number in (*range(128), *range(-128, 0))]
# YAML wants a point in a number: 1e-05 would be a text.
_NO_POINT = re.compile(r"(?<![\d.])(\d+)e")


@dataclass(frozen=True, slots=True, eq=False)
class Numbers:
    """A sequence of numbers or truth values of a message; ``is_cut``: its start."""

    items: "np.ndarray[Any, Any] | array[Any] | list[bool]"
    is_cut: bool = False

    def plain(self) -> list[Any]:
        """As a list that ends in :data:`CUT` if it is cut."""
        items = self.items if isinstance(self.items, list) else self.items.tolist()
        return [*items, CUT] if self.is_cut else items


@dataclass(frozen=True, slots=True)
class Layout:
    """How arrays stand in a text.

    Args:
        flow: all of the text in one line, arrays in brackets.
        width: of the terminal of a person who reads it: arrays in brackets, in lines
            of at most so many characters. Without it an item a line.
    """

    flow: bool = False
    width: int | None = None


def with_numbers(
    around: Sequence[str], arrays: Sequence[Numbers], layout: Layout
) -> Iterator[str]:
    """A text in pieces: in turn what stands around the arrays, and an array."""
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
    """In brackets, in lines that end between two numbers."""
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
    """The numbers as Python writes them."""
    kind = values.dtype.kind
    if kind in "iu" and values.itemsize == 1:
        words = _UNSIGNED if kind == "u" else _SIGNED
        return between.join(map(words.__getitem__, values.tobytes()))
    return str(values.tolist())[1:-1].replace(", ", between)
