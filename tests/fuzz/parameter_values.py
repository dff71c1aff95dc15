"""Extreme values of parameters, from their types and declared ranges."""

import math
from collections.abc import Iterator
from dataclasses import Field, fields
from typing import Any

from navette.params import ParamInfo, Params, info_of
from navette.runtime.parameter import ParameterType

_FLOATS = (
    *(math.nan, math.inf, -math.inf, 1.7976931348623157e308, -1e308, 1e308),
    *(5e-324, -5e-324, 1e-300, -0.0, 0.0, 1.0, -1.0, 1e9, 1e-9, 1e5, 1e-3),
)
_INTEGERS = (0, 1, -1, 2**31 - 1, -(2**31), 2**31, 2**63 - 1, -(2**63), 10**9, 100_000)
_STRINGS = ("", "\0", "nowhere", "a" * 10_000, "\x1b[31m", "地図", "/", "{}%s")
_SCALARS: dict[ParameterType, tuple[Any, ...]] = {
    ParameterType.DOUBLE: _FLOATS,
    ParameterType.INTEGER: _INTEGERS,
    ParameterType.STRING: _STRINGS,
    ParameterType.BOOL: (True, False),
}
_ARRAYS = {
    ParameterType.DOUBLE_ARRAY: ParameterType.DOUBLE,
    ParameterType.INTEGER_ARRAY: ParameterType.INTEGER,
    ParameterType.STRING_ARRAY: ParameterType.STRING,
    ParameterType.BOOL_ARRAY: ParameterType.BOOL,
    ParameterType.BYTE_ARRAY: ParameterType.INTEGER,
}
_LENGTHS = (0, 1, 2, 3, 6, 15, 225, 10_000)


def extremes(kind: ParameterType, info: ParamInfo | None) -> Iterator[Any]:
    """Yield values of the parameter's type: extremes and the ends of its range."""
    if kind in _ARRAYS:
        for value in _SCALARS[_ARRAYS[kind]]:
            for length in _LENGTHS:
                yield [value] * length
        return
    yield from _SCALARS[kind]
    if info is None:
        return
    if kind is ParameterType.STRING:
        yield from info.choices
    for bound in (info.at_least, info.at_most, info.above, info.below):
        if bound is None:
            continue
        if kind is ParameterType.INTEGER:
            yield from (int(bound) - 1, int(bound), int(bound) + 1)
        elif kind is ParameterType.DOUBLE:
            yield from (
                float(bound),
                math.nextafter(bound, math.inf),
                math.nextafter(bound, -math.inf),
            )


def wrong_types(kind: ParameterType) -> Iterator[Any]:
    """Yield values of every other type."""
    yield from (
        value
        for other, value in (
            (ParameterType.DOUBLE, 1.5),
            (ParameterType.INTEGER, 1),
            (ParameterType.STRING, "1"),
            (ParameterType.BOOL, True),
            (ParameterType.DOUBLE_ARRAY, [1.5]),
            (ParameterType.STRING_ARRAY, ["a"]),
        )
        if other is not kind
    )


def infos(params_class: type[Params]) -> dict[str, ParamInfo]:
    """Return the declared ranges by parameter."""
    found: tuple[Field[Any], ...] = fields(params_class)
    return {each.name: info_of(each) for each in found}
