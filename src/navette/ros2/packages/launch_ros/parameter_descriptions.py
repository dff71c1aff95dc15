"""Parameter values and parameter files with substitutions."""

import types
from collections.abc import Iterable
from pathlib import Path
from typing import Any, get_args, get_origin

from navette.errors import FileFormatError, ParameterError
from navette.ros2.packages.launch import SomeSubstitutionsType, Substitution
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.frontend import parse_substitution
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    perform_substitutions,
)
from navette.ros2.packages.launch.typed import perform_bool
from navette.runtime.parameter_files import parse_value

_SCALARS: dict[str, type] = {"int": int, "float": float, "bool": bool, "str": str}


class ParameterValue:
    """A value, or substitutions that produce it.

    Args:
        value: a value, substitutions, or a list of values.
        value_type: type of the value: ``int``, ``float``, ``bool``, ``str``, or a list
            of one of these (``List[int]``); None: by the rules of parameter files.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value = value
        self.value_type = value_type
        _checked_type(value_type)

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value, of the requested type.

        Raises:
            ParameterError: the value has another type.
        """
        value = self.value
        if isinstance(value, ParameterValue):
            value = value.evaluate(context)
        elif _has_substitutions(value):
            text = Parts.of(value).perform(context)
            value = text if self.value_type is str else parse_value(text)
        elif isinstance(value, (list, tuple)):
            value = [_item(context, each) for each in value]
        elif isinstance(value, Path):
            value = str(value)
        return value if self.value_type is None else _as_type(value, self.value_type)


def _has_substitutions(value: Any) -> bool:
    """Return whether a value is a substitution or a list to join."""
    if isinstance(value, Substitution):
        return True
    if not isinstance(value, (list, tuple)):
        return False
    return (
        bool(value)
        and all(isinstance(each, (str, Substitution)) for each in value)
        and any(isinstance(each, Substitution) for each in value)
    )


def _item(context: LaunchContext, value: Any) -> Any:
    if isinstance(value, (Substitution, list, tuple)):
        text = Parts.of(value).perform(context)
        return parse_value(text)
    return value


def _checked_type(value_type: Any) -> tuple[type | None, bool]:
    """Return the scalar type and whether it is a list of them."""
    if value_type is None:
        return None, False
    is_list = get_origin(value_type) is list or isinstance(
        value_type, types.GenericAlias
    )
    scalar = (get_args(value_type) or (None,))[0] if is_list else value_type
    if scalar not in _SCALARS.values():
        raise InvalidLaunchValueError(
            f"value_type {value_type!r}: expected int, float, bool, str or a "
            "list of one of these, as in List[int]"
        )
    return scalar, is_list


def _as_type(value: Any, value_type: Any) -> Any:
    scalar, is_list = _checked_type(value_type)
    if is_list:
        if not isinstance(value, list):
            raise ParameterError(f"value {value!r}: expected a list, {value_type}")
        return [_as_scalar(each, scalar) for each in value]
    return _as_scalar(value, scalar)


def _as_scalar(value: Any, scalar: type | None) -> Any:
    if scalar is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if scalar is str and not isinstance(value, list):
        return str(value).lower() if isinstance(value, bool) else str(value)
    if scalar is not None and type(value) is not scalar:
        raise ParameterError(f"value {value!r}: expected {scalar.__name__}")
    return value


class Parameter:
    """A named value, an item of ``parameters=[…]``."""

    def __init__(
        self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None
    ) -> None:
        self._name = Parts.of(name)
        self._value = ParameterValue(value, value_type=value_type)

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return name and value."""
        return self._name.perform(context), self._value.evaluate(context)


class ParameterFile:
    """A parameter file.

    Args:
        param_file: its path.
        allow_substs: perform the substitutions in the file.
    """

    def __init__(
        self, param_file: SomeSubstitutionsType, *, allow_substs: Any = False
    ) -> None:
        self._path = Parts.of(param_file)
        self._allow_substs = allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the path of the file, or of a copy with substitutions performed.

        Raises:
            FileFormatError: the file does not exist, or a substitution fails.
        """
        path = Path(self._path.perform(context))
        if not path.is_file():
            raise FileFormatError(path, "no such parameter file")
        if not perform_bool(context, self._allow_substs):
            return path
        text = path.read_text(encoding="utf-8")
        try:
            done = perform_substitutions(context, parse_substitution(text))
        except ValueError as error:
            raise FileFormatError(path, str(error)) from error
        performed = context.scratch_folder() / f"{len(text)}_{abs(hash(done))}.yaml"
        performed.write_text(done, encoding="utf-8")
        return performed


def evaluate_dict(
    context: LaunchContext, values: dict[Any, Any], prefix: str = ""
) -> list[tuple[str, Any]]:
    """Return the (name, value) pairs of a dict; names of nested dicts are dotted."""
    found: list[tuple[str, Any]] = []
    for key, value in values.items():
        keys = (
            list(key) if isinstance(key, Iterable) and not isinstance(key, str) else key
        )
        name = Parts.of(keys).perform(context)
        name = f"{prefix}{name}"
        if isinstance(value, dict):
            found += evaluate_dict(context, value, f"{name}.")
        else:
            if not isinstance(value, ParameterValue):
                value = ParameterValue(value)
            found.append((name, value.evaluate(context)))
    return found
