"""Parameter values and parameter files with substitutions."""

import atexit
import os
from functools import cache
from pathlib import Path
from tempfile import NamedTemporaryFile, TemporaryDirectory
from typing import Any, get_args

import yaml

from navette.errors import FileFormatError
from navette.files.untrusted.yaml_input import load_yaml
from navette.ros2.packages.launch import SomeSubstitutionsType
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.frontend import parse_substitution
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch.utilities.type_utils import (
    extract_type,
    normalize_typed_substitution,
    perform_typed_substitution,
)
from navette.runtime.strict_mode import is_strict


class ParameterValue:
    """A value, or substitutions that produce it.

    Args:
        value: a value, substitutions, or a list of values.
        value_type: type of the value: ``int``, ``float``, ``bool``, ``str``, or a list
            of one of these (``List[int]``); None: by the rules of YAML.

    Raises:
        TypeError: neither a value of the type nor substitutions.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        try:
            number = _as_float(value, value_type)
            self._given = normalize_typed_substitution(number, value_type)
        except (TypeError, ValueError) as error:
            raise InvalidLaunchValueError(f"parameter value: {error}") from error
        self.value = self._given
        self.value_type = value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value, which ``value`` is from then on.

        Raises:
            TypeError: the value has another type.
            ValueError: a text has no value of the type.
        """
        self.value = perform_typed_substitution(context, self._given, self.value_type)
        return self.value

    def __str__(self) -> str:
        return f"ParameterValue(value={self.value}, value_type={self.value_type})"


def _as_float(value: Any, value_type: Any) -> Any:
    """Return integers as floats where floats are expected, except in strict mode."""
    if value_type is None or extract_type(value_type)[0] is not float or is_strict():
        return value
    if isinstance(value, list) and get_args(value_type):
        return [float(item) if type(item) is int else item for item in value]
    return float(value) if type(value) is int else value


class Parameter:
    """A named value, an item of ``parameters=[…]``."""

    def __init__(
        self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None
    ) -> None:
        self.name: Parts | str = Parts.of(name)
        self._name = Parts.of(name)
        self._value = ParameterValue(value, value_type=value_type)

    @property
    def value(self) -> Any:
        return self._value.value

    @property
    def value_type(self) -> Any:
        return self._value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return name and value, which the attributes are from then on."""
        self.name = self._name.perform(context)
        return self.name, self._value.evaluate(context)

    def __str__(self) -> str:
        return (
            f"Parameter(name={self.name}, value={self.value}, "
            f"value_type={self.value_type})"
        )


class ParameterFile:
    """A parameter file.

    Args:
        param_file: its path.
        allow_substs: perform the substitutions in the file.
    """

    def __init__(
        self, param_file: SomeSubstitutionsType | bytes, *, allow_substs: Any = False
    ) -> None:
        is_path = isinstance(param_file, (bytes, os.PathLike))
        path = os.fsdecode(param_file) if is_path else param_file  # type: ignore[arg-type] # by is_path
        self._path = Parts.of(path)
        self._allow_substs = normalize_typed_substitution(allow_substs, bool)
        self._copy: Path | None = None
        self.param_file: Parts | Path = self._path
        self.allow_substs = self._allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the path of the file, or of a copy with substitutions performed.

        Raises:
            FileFormatError: the file cannot be read, or a substitution fails.
        """
        path = Path("".join(context.perform_substitution(part) for part in self._path))
        self.allow_substs = perform_typed_substitution(
            context, self._allow_substs, bool
        )
        if self.allow_substs:
            path = self._copy = _performed(context, path)
        self.param_file = path
        return path

    def cleanup(self) -> None:
        """Delete the copy."""
        if self._copy is not None:
            self._copy.unlink(missing_ok=True)
            self._copy, self.param_file = None, self._path

    def __str__(self) -> str:
        return (
            f"ParameterFile(param_file={self.param_file}, "
            f"allow_substs={self.allow_substs})"
        )


def _performed(context: LaunchContext, path: Path) -> Path:
    """Return a copy of a file with its substitutions performed."""
    try:
        parts = parse_substitution(path.read_text(encoding="utf-8"))
        text = "".join(context.perform_substitution(part) for part in parts)
        load_yaml(text)
    except OSError as error:
        reason = error.strerror or str(error)
        raise FileFormatError(path, reason) from error
    except (ValueError, yaml.YAMLError) as error:
        raise FileFormatError(path, str(error)) from error
    return write_parameter_file(text)


def write_parameter_file(text: str) -> Path:
    """Return a new parameter file, which is deleted when this process ends."""
    with NamedTemporaryFile(
        "w", prefix="launch_params_", suffix=".yaml", dir=_folder(), delete=False
    ) as file:
        file.write(text)
    return Path(file.name)


@cache
def _folder() -> Path:
    folder = TemporaryDirectory(prefix="navette_launch_")
    atexit.register(folder.cleanup)
    return Path(folder.name)
