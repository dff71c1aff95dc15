"""YAML of a message's values in the form of ``ros2 topic echo``."""

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
# Arrays with fewer numbers are left to the YAML emitter.
_FEW = 16
_INTEGER = "tag:yaml.org,2002:int"


class _Placeholders:
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


def _dumper(base: Any) -> Any:
    """Return a YAML dumper class that writes placeholders for arrays."""

    class Dumper(base):  # type: ignore[misc] # the base is a variable
        def __init__(
            self, *arguments: Any, placeholders: _Placeholders, **options: Any
        ) -> None:
            super().__init__(*arguments, **options)
            self.placeholders = placeholders

    Dumper.add_representer(
        Numbers, lambda dumper, n: dumper.placeholders.represent(dumper, n)
    )
    return Dumper


_PYTHON_DUMPER = _dumper(yaml.SafeDumper)
_C_DUMPER = _dumper(getattr(yaml, "CSafeDumper", yaml.SafeDumper))


def yaml_text(value: Any, layout: Layout) -> Iterator[str]:
    """Return a value as YAML in the pieces of :func:`with_numbers`.

    Args:
        value: dicts, lists, texts, numbers and :class:`Numbers`.
    """
    if isinstance(value, Numbers) and len(value.items):
        return with_numbers(("", "\n"), [value], layout)
    dumper, mark = _C_DUMPER, "0xa"
    while True:
        placeholders = _Placeholders(mark, _FEW if layout.width is None else 1)
        text: str = yaml.dump(
            value,
            Dumper=partial(dumper, placeholders=placeholders),
            allow_unicode=True,
            width=_WIDTH,
            default_flow_style=layout.flow,
            sort_keys=False,
        )
        around = text.split(mark)
        if "\\U" in text and dumper is _C_DUMPER:
            dumper = _PYTHON_DUMPER  # libyaml escapes emojis, PyYAML does not
        elif len(around) > len(placeholders.arrays) + 1:
            # A text of the message contains the mark: use a longer one.
            mark = f"{mark}{max(re.findall('a+', text), key=len)}"
        else:
            return with_numbers(around, placeholders.arrays, layout)
