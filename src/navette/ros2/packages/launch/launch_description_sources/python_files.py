"""Sources of Python launch files."""

import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_source import (
    LaunchDescriptionSource,
)

_FUNCTION = "generate_launch_description"


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """A Python launch file raised, or has no ``generate_launch_description``."""


def load_python_launch_file_as_module(path: Path | str) -> ModuleType:
    """Run the file as a module that is not importable by name.

    Raises:
        InvalidPythonLaunchFileError: the file raised; names the line.
    """
    path = Path(path)
    loader = SourceFileLoader(f"navette_launch_file_{abs(hash(path))}", str(path))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None, "created from a loader"
    module = module_from_spec(spec)
    writes_bytecode, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        loader.exec_module(module)
    except Exception as error:  # the file's own code may raise anything
        raise _error(path, error) from error
    finally:
        sys.dont_write_bytecode = writes_bytecode
    return module


def get_launch_description_from_python_launch_file(
    launch_file_path: Path | str,
) -> LaunchDescription:
    """Return the result of the file's ``generate_launch_description()``.

    Raises:
        InvalidPythonLaunchFileError: the function is missing, raised, or returned
            another type.
    """
    path = Path(launch_file_path)
    module = load_python_launch_file_as_module(path)
    function: Any = getattr(module, _FUNCTION, None)
    if function is None:
        raise InvalidPythonLaunchFileError(f"{path}: has no {_FUNCTION}()")
    try:
        description = function()
    except Exception as error:  # as above
        raise _error(path, error) from error
    if not isinstance(description, LaunchDescription):
        raise InvalidPythonLaunchFileError(
            f"{path}: {_FUNCTION}() returned {description!r}; expected a "
            "LaunchDescription"
        )
    return description


def _error(path: Path, error: Exception) -> InvalidPythonLaunchFileError:
    line = getattr(error, "lineno", None) if isinstance(error, SyntaxError) else None
    trace = error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == str(path):
            line = trace.tb_lineno
        trace = trace.tb_next
    where = f"{path}:{line}" if line else str(path)
    return InvalidPythonLaunchFileError(f"{where}: {type(error).__name__}: {error}")


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """Source of a Python launch file."""

    def __init__(self, launch_file_path: Any) -> None:
        super().__init__(None, launch_file_path, "interpreted python launch file")

    def read(self, path: Path) -> LaunchDescription:
        return get_launch_description_from_python_launch_file(path)
