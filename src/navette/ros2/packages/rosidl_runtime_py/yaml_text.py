"""YAML of a message's values, in the form that ``ros2 topic echo`` prints."""

import re
from collections.abc import Iterator
from functools import partial
from typing import Any

import yaml

from navette.ros2.packages.rosidl_runtime_py.number_text import (
    Layout,
    Numbers,
    with_numbers,
)

# One line per value, however long; libyaml's width is a C int.
_WIDTH = 2**31 - 1
# YAML's emitter writes so few numbers soon enough.
_FEW = 16
_INTEGER = "tag:yaml.org,2002:int"


class _Gaps:
    """Arrays that are left out of a text, and the mark in place of each."""

    def __init__(self, mark: str, least: int) -> None:
        self.mark = mark
        self._least = least
        self.arrays: list[Numbers] = []

    def represent(self, dumper: Any, numbers: Numbers) -> Any:
        if len(numbers.items) < self._least:
            return dumper.represent_list(numbers.plain())
        self.arrays.append(numbers)
        return dumper.represent_scalar(_INTEGER, self.mark)


def _leaving(base: Any) -> Any:
    """A YAML dumper that leaves out arrays."""

    class Dumper(base):  # type: ignore[misc]
        def __init__(self, *arguments: Any, gaps: _Gaps, **options: Any) -> None:
            super().__init__(*arguments, **options)
            self.gaps = gaps

    Dumper.add_representer(Numbers, lambda dumper, n: dumper.gaps.represent(dumper, n))
    return Dumper


_PYTHONS = _leaving(yaml.SafeDumper)
_FASTER = _leaving(getattr(yaml, "CSafeDumper", yaml.SafeDumper))


def yaml_text(value: Any, layout: Layout) -> Iterator[str]:
    """A value as YAML, in the pieces of :func:`with_numbers`.

    Args:
        value: dicts, lists, texts, numbers, and :class:`Numbers`.
    """
    if isinstance(value, Numbers) and len(value.items):
        return with_numbers(("", "\n"), [value], layout)
    dumper, mark = _FASTER, "0xa"
    while True:
        gaps = _Gaps(mark, _FEW if layout.width is None else 1)
        text: str = yaml.dump(
            value,
            Dumper=partial(dumper, gaps=gaps),
            allow_unicode=True,
            width=_WIDTH,
            default_flow_style=layout.flow,
            sort_keys=False,
        )
        around = text.split(mark)
        if "\\U" in text and dumper is _FASTER:
            dumper = _PYTHONS  # libyaml escapes an emoji, PyYAML writes it
        elif len(around) > len(gaps.arrays) + 1:
            # The mark stands in a text of the message; a longer one does not.
            mark = f"{mark}{max(re.findall('a+', text), key=len)}"
        else:
            return with_numbers(around, gaps.arrays, layout)
