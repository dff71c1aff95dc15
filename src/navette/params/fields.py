"""Parameters of a stage as a frozen dataclass: default, unit, range, meaning.

A stage declares::

    @dataclass(frozen=True, kw_only=True)
    class CostmapParams(Params):
        resolution_m: float = param(0.1, "edge of a cell", above=0.0)

A name ends in its unit (:data:`UNITS`). The values are validated on construction. The
runtime declares the fields as ROS 2 parameters with the same description and range.
"""

import dataclasses
import types
import typing
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

from navette.errors import ParameterError, instead_of


@dataclass(frozen=True)
class ParamInfo:
    """Meaning and allowed values of a parameter; bounds are in its unit."""

    meaning: str
    unit: str = ""
    at_least: float | None = None
    at_most: float | None = None
    above: float | None = None
    below: float | None = None
    #: Allowed texts; may be a registry of methods.
    choices: Collection[str] = ()

    def allowed(self) -> str:
        """Describe the allowed values, for error messages and the reference."""
        if self.choices:
            return "one of " + ", ".join(self.choices)
        bounds = [
            f"{sign} {bound:g}"
            for sign, bound in (
                (">=", self.at_least),
                (">", self.above),
                ("<=", self.at_most),
                ("<", self.below),
            )
            if bound is not None
        ]
        return " and ".join(bounds) or "any"


LARGEST = 1e9
"""Largest magnitude of a float; beyond it no range of a field has a meaning."""

UNITS = {
    "_m": "m",
    "_mps": "m/s",
    "_mps2": "m/s²",
    "_rad": "rad",
    "_radps": "rad/s",
    "_radps2": "rad/s²",
    "_deg": "deg",
    "_s": "s",
    "_hz": "Hz",
    "_kg": "kg",
    "_bytes": "B",
    "_per_m": "1/m",
    "_per_m2": "1/m²",
    "_per_m3": "1/m³",
    "_m_per_rad": "m/rad",
}
"""End of a parameter's name → its unit."""

_KEY = "navette.param"


def param(
    default: Any,
    meaning: str,
    *,
    unit: str = "",
    at_least: float | None = None,
    at_most: float | None = None,
    above: float | None = None,
    below: float | None = None,
    choices: Collection[str] = (),
) -> Any:
    """Make a dataclass field with a :class:`ParamInfo`.

    Args:
        default: value of the field.
        meaning: one phrase, for the reference and ``ros2 param describe``.
        unit: for a name that does not end in its unit.
        at_least, at_most: least and largest value allowed.
        above, below: bounds that are not allowed themselves.
        choices: allowed texts.
    """
    info = ParamInfo(meaning, unit, at_least, at_most, above, below, choices)
    return dataclasses.field(default=default, metadata={_KEY: info})


@dataclass(frozen=True, kw_only=True)
class Params:
    """Base class of the parameters of a stage; checks each field on construction.

    Field types: bool, int, float, str and tuples of these (ROS 2 arrays). An int for a
    float is converted; any other value of a wrong type raises. Floats are finite and
    within ±1e9 in any unit, which keeps sums, squares and nanoseconds finite.

    Raises:
        ParameterError: names the field, the value and the allowed values.
    """

    def __post_init__(self) -> None:
        hints = typing.get_type_hints(type(self))
        for field in dataclasses.fields(self):
            value = getattr(self, field.name)
            value = _convert(field.name, value, hints[field.name])
            _check_range(field.name, value, info_of(field))
            object.__setattr__(self, field.name, value)
        self.check()

    def check(self) -> None:
        """Check conditions between fields; override in derived classes."""

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> typing.Self:
        """Make parameters from plain values.

        Raises:
            ParameterError: an unknown key (the error names similar ones), or a wrong
                value.
        """
        known = [field.name for field in dataclasses.fields(cls)]
        for key in values:
            if key not in known:
                see_all = f"the fields of {cls.__name__}"
                raise ParameterError(
                    f"unknown parameter {key!r}"
                    f"{instead_of(key, known, see_all=see_all)}"
                )
        return cls(**values)


def info_of(field: "dataclasses.Field[Any]") -> ParamInfo:
    """Return the :class:`ParamInfo` of a field, with its unit."""
    info = field.metadata.get(_KEY)
    if not isinstance(info, ParamInfo):
        info = ParamInfo(field.name)
    return info if info.unit else dataclasses.replace(info, unit=unit_of(field.name))


def unit_of(name: str) -> str:
    """Return the unit in which a parameter's name ends; empty: none."""
    endings = [ending for ending in UNITS if name.endswith(ending)]
    return UNITS[max(endings, key=len)] if endings else ""


def _convert(name: str, value: Any, hint: Any) -> Any:
    if isinstance(hint, types.GenericAlias) and hint.__origin__ is tuple:
        if isinstance(value, str) or not isinstance(value, Sequence):
            raise _wrong_type(name, value, hint)
        return tuple(_convert(name, item, hint.__args__[0]) for item in value)
    if hint is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if hint is int and isinstance(value, bool):
        raise _wrong_type(name, value, hint)
    if not isinstance(value, hint):
        raise _wrong_type(name, value, hint)
    return value


def _wrong_type(name: str, value: Any, hint: Any) -> ParameterError:
    expected = getattr(hint, "__name__", str(hint))
    return ParameterError(
        f"parameter {name!r}: {value!r} is {type(value).__name__}, expected {expected}"
    )


def _check_range(name: str, value: Any, info: ParamInfo) -> None:
    for item in value if isinstance(value, tuple) else (value,):
        if not _in_range(item, info):
            allowed = info.allowed()
            if isinstance(item, float) and not abs(item) <= LARGEST:
                allowed = f"a finite number within ±{LARGEST:g}"
            raise ParameterError(
                f"parameter {name!r}: {item!r} is not allowed; "
                f"must be {allowed}{' ' + info.unit if info.unit else ''}"
            )


def _in_range(value: Any, info: ParamInfo) -> bool:
    if isinstance(value, str):
        return not info.choices or value in info.choices
    if isinstance(value, bool):
        return True
    return (
        (isinstance(value, int) or abs(value) <= LARGEST)
        and (info.at_least is None or value >= info.at_least)
        and (info.at_most is None or value <= info.at_most)
        and (info.above is None or value > info.above)
        and (info.below is None or value < info.below)
    )
