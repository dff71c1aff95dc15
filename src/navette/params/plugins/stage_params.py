"""Parameters of chosen methods, beside those of their stage.

A stage has a field such as ``method`` whose choices are a registry. The fields of the
chosen method's dataclass become parameters of the stage's node; a field with the name
of a stage's parameter receives the stage's value.
"""

import dataclasses
import typing
from collections.abc import Mapping
from typing import Any, TypeVar

from navette.errors import NavetteError, ParameterError
from navette.params import Params, info_of
from navette.params.plugins.parameters import values_of
from navette.params.plugins.registry import MethodRegistry

P = TypeVar("P", bound=Params)

_PLAIN = (bool, int, float, str)


def with_methods(params_class: type[P], chosen: Mapping[str, Any]) -> type[P]:
    """Return the class with the fields of the chosen methods.

    Args:
        params_class: parameters of a stage.
        chosen: values of its fields that are not the defaults.

    Raises:
        ParameterError: a method is unknown or cannot be loaded, or a field of its
            dataclass cannot be a parameter.
    """
    known = {each.name for each in dataclasses.fields(params_class)}
    added: list[tuple[str, Any, Any]] = []
    checked: list[type[Params]] = []
    defaults = {each.name: each.default for each in dataclasses.fields(params_class)}
    for name, registry in method_fields(params_class).items():
        kind = _load(registry, name, chosen.get(name, defaults[name]))
        added += _fields_of(kind, known)
        if kind is not None and issubclass(kind, Params):
            checked.append(kind)
    if not added:
        return params_class

    def check(self: Params) -> None:
        params_class.check(typing.cast(P, self))
        for kind in checked:
            kind(**values_of(kind, self))

    extended = dataclasses.make_dataclass(
        params_class.__name__,
        added,
        bases=(params_class,),
        frozen=True,
        kw_only=True,
        namespace={"check": check, "__doc__": params_class.__doc__},
    )
    return typing.cast(type[P], extended)


def method_fields(params_class: type[Params]) -> dict[str, MethodRegistry]:
    """Return the fields that choose a method."""
    found = {f.name: info_of(f).choices for f in dataclasses.fields(params_class)}
    return {k: v for k, v in found.items() if isinstance(v, MethodRegistry)}


def own_fields(params: Params, params_class: type[Params]) -> dict[str, Any]:
    """Return the parameters that a method adds to those of its stage."""
    known = {each.name for each in dataclasses.fields(params_class)}
    return {
        each.name: getattr(params, each.name)
        for each in dataclasses.fields(params)
        if each.name not in known
    }


def _load(registry: MethodRegistry, parameter: str, name: Any) -> type[Any] | None:
    if not isinstance(name, str):
        return None  # refused with the other values of a wrong type
    try:
        return registry.load(name).params_class
    except NavetteError as error:
        raise ParameterError(f"parameter {parameter!r}: {error}") from error


def _fields_of(
    kind: type[Any] | None, known: set[str]
) -> list[tuple[str, Any, "dataclasses.Field[Any]"]]:
    if kind is None:
        return []
    hints = typing.get_type_hints(kind)
    found = []
    for each in dataclasses.fields(kind):
        if each.name in known or not each.init:
            continue
        hint = hints[each.name]
        where = f"parameter {each.name!r} of {kind.__qualname__}"
        if not _is_parameter(hint):
            raise ParameterError(
                f"{where} is of type {getattr(hint, '__name__', hint)}; a parameter is "
                "bool, int, float, str or a tuple of one of these, as tuple[float, ...]"
            )
        if each.default is dataclasses.MISSING:
            raise ParameterError(f"{where} has no default; give it one")
        field = dataclasses.field(default=each.default, metadata=each.metadata)
        found.append((each.name, hint, field))
    return found


def _is_parameter(hint: Any) -> bool:
    if typing.get_origin(hint) is tuple:
        return typing.get_args(hint)[0] in _PLAIN
    return hint in _PLAIN
