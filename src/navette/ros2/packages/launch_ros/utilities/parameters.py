"""Parameters of nodes: from what launch files give to what programs receive.

*Normalized* parameters are a tuple of parameter files, :class:`Parameter` items, and
dicts whose names and values are tuples of substitutions, or plain values. *Evaluated*
ones are paths, :class:`Parameter` items, and dicts of values.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError
from navette.files.untrusted.yaml_input import load_yaml
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts, Substitution
from navette.ros2.packages.launch_ros.parameter_descriptions import (
    Parameter,
    ParameterFile,
    ParameterValue,
)
from navette.runtime import Parameter as NodeParameter
from navette.runtime.overrides import OverrideSet
from navette.runtime.parameter_files import (
    RosLoader,
    format_value,
    read_parameter_file,
)

Name = tuple[Substitution, ...]
NormalizedDict = dict[Name, Any]
Normalized = tuple[ParameterFile | Parameter | NormalizedDict, ...]
EvaluatedDict = dict[str, Any]
Evaluated = tuple[Path | Parameter | EvaluatedDict, ...]

_SCALARS = (bool, int, float, str)
_MARK = "ros__parameters"


def normalize_parameters(parameters: Any) -> Normalized:
    """Return the normalized form of ``parameters=[…]``.

    Raises:
        TypeError: not a list, or an item is not a path, dict or Parameter.
    """
    if isinstance(parameters, str) or not isinstance(parameters, Sequence):
        raise InvalidLaunchValueError(
            f"parameters {parameters!r}: expected a list, as in parameters=[…]"
        )
    return tuple(_normalize(item) for item in parameters)


def _normalize(item: Any) -> ParameterFile | Parameter | NormalizedDict:
    if isinstance(item, Mapping):
        return normalize_parameter_dict(item)
    if isinstance(item, (Parameter, ParameterFile)):
        return item
    try:
        return ParameterFile(item)
    except TypeError:
        raise InvalidLaunchValueError(
            f"parameters: {item!r} ({type(item).__name__}): expected a dict, the path "
            "of a file, or a Parameter"
        ) from None


def normalize_parameter_dict(
    parameters: Mapping[Any, Any], *, _prefix: Name = ()
) -> NormalizedDict:
    """Return a flat dict; the names of nested dicts are joined with dots.

    Text stays text. A list with substitutions is joined to one text, whose value is
    read as YAML; a list of lists of substitutions is a list of such values.

    Raises:
        TypeError: not a dict, or a value that parameters cannot have.
    """
    if not isinstance(parameters, Mapping):
        raise InvalidLaunchValueError(f"parameters {parameters!r}: expected a dict")
    found: NormalizedDict = {}
    for key, value in parameters.items():
        name = (*_prefix, *Parts.of(key))
        if isinstance(value, Mapping):
            inner = (*name, *Parts.of("."))
            found |= normalize_parameter_dict(value, _prefix=inner)
        else:
            found[name] = _normalize_value(Parts(name).describe(), value)
    return found


def _normalize_value(name: str, value: Any) -> Any:
    if isinstance(value, (ParameterValue, bool, int, float, bytes)):
        return value
    if isinstance(value, (str, Path)):
        return tuple(Parts.of(format_value(str(value))))
    if isinstance(value, Substitution):
        return (value,)
    if isinstance(value, Sequence):
        return _normalize_list(value)
    raise InvalidLaunchValueError(
        f"parameter {name}: {value!r} ({type(value).__name__}): expected a bool, int, "
        "float, text, bytes, substitutions or a list of these"
    )


def _normalize_list(values: Sequence[Any]) -> tuple[Any, ...]:
    kinds = {type(value) for value in values}
    if kinds and kinds <= {int, float}:
        return tuple(float(v) for v in values) if float in kinds else tuple(values)
    if kinds == {bool}:
        return tuple(values)
    is_joined = all(isinstance(value, (str, Substitution)) for value in values)
    if is_joined and any(isinstance(value, Substitution) for value in values):
        return tuple(Parts.of(values))
    return tuple(_normalize_item(value) for value in values)


def _normalize_item(value: Any) -> Parts:
    if isinstance(value, (bool, int, float)):
        return Parts.of(format_value(value))
    return Parts.of(
        format_value(str(value)) if isinstance(value, (str, Path)) else value
    )


def evaluate_parameters(context: LaunchContext, parameters: Normalized) -> Evaluated:
    """Return the values of normalized parameters.

    Raises:
        TypeError: a value that parameters cannot have.
    """
    return tuple(
        item.evaluate(context)
        if isinstance(item, ParameterFile)
        else item
        if isinstance(item, Parameter)
        else evaluate_parameter_dict(context, item)
        for item in parameters
    )


def evaluate_parameter_dict(
    context: LaunchContext, parameters: NormalizedDict
) -> EvaluatedDict:
    """Return the values of a normalized dict.

    Raises:
        TypeError: a value that parameters cannot have.
    """
    if not isinstance(parameters, Mapping):
        raise InvalidLaunchValueError(f"parameters {parameters!r}: expected a dict")
    found: EvaluatedDict = {}
    for parts, value in parameters.items():
        name = _perform(context, parts)
        found[name] = _evaluate(context, name, value)
    return found


def _perform(context: LaunchContext, parts: Sequence[Substitution]) -> str:
    return "".join(context.perform_substitution(part) for part in parts)


def _evaluate(context: LaunchContext, name: str, value: Any) -> Any:
    if isinstance(value, ParameterValue):
        try:
            return value.evaluate(context)
        except (TypeError, ValueError) as error:
            raise InvalidLaunchValueError(f"parameter {name}: {error}") from error
    if not isinstance(value, tuple):
        return value
    if value and isinstance(value[0], Substitution):
        found = _read(name, _perform(context, value))
        return _checked_items(name, found) if isinstance(found, list) else found
    if value and not isinstance(value[0], Sequence):
        return value
    return _checked_items(name, [_read(name, _perform(context, v)) for v in value])


def _read(name: str, text: str) -> Any:
    """Return the value of a text by the rules of parameter files."""
    hint = "to keep it as text, write ParameterValue(…, value_type=str)"
    try:
        value = load_yaml(text, RosLoader) if text else text
    except yaml.YAMLError:
        raise InvalidLaunchValueError(
            f"Unable to parse the value of parameter {name}, {text!r}, as YAML; {hint}"
        ) from None
    if not isinstance(value, (*_SCALARS, list)):
        raise InvalidLaunchValueError(
            f"parameter {name}: {text!r} is YAML of type {type(value).__name__}. "
            f"Allowed value types are bytes, bool, int, float, str and lists; {hint}"
        )
    return value


def _checked_items(name: str, values: Sequence[Any]) -> tuple[Any, ...]:
    kinds = {type(value) for value in values}
    if len(kinds) != 1 or not kinds <= set(_SCALARS):
        raise InvalidLaunchValueError(
            "Expected a non-empty sequence of items of one type (bool, int, float or "
            f"str); parameter {name} is {list(values)!r}"
        )
    return tuple(values)


def to_parameters_list(
    context: LaunchContext,
    node_name: str,
    namespace: str | None,
    evaluated_parameters: Evaluated,
) -> list[NodeParameter[Any]]:
    """Return evaluated parameters as those of a node, files with their contents."""
    full_name = f"{(namespace or '').rstrip('/')}/{node_name.lstrip('/')}"
    found: list[NodeParameter[Any]] = []
    for item in evaluated_parameters:
        if isinstance(item, Path):
            values = _values_in_file(context, item, f"/{full_name.lstrip('/')}")
        elif isinstance(item, Parameter):
            values = dict([item.evaluate(context)])
        else:
            values = item
        found += [NodeParameter(name, value=value) for name, value in values.items()]
    return found


def _values_in_file(
    context: LaunchContext, path: Path, full_name: str
) -> dict[str, Any]:
    """Return a node's values; those of its name override those of patterns.

    A file without node names has the values of all.
    """
    try:
        text = path.read_text(encoding="utf-8")
        document = {} if _MARK in text else load_yaml(text, RosLoader)
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise FileFormatError(path, str(error)) from error
    if _MARK not in text:
        return evaluate_parameter_dict(
            context, normalize_parameter_dict(document or {})
        )
    patterns: dict[str, Any] = {}
    named: dict[str, Any] = {}
    for pattern, values in read_parameter_file(path):
        if f"/{pattern.lstrip('/')}" == full_name:
            named |= values
        elif OverrideSet(f"/{pattern.strip('/')}", {}, "").matches(full_name):
            patterns |= values
    return patterns | named
