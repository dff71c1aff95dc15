"""Launch files in Python: ``generate_launch_description()``."""

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
    """A Python launch file raised, or lacks ``generate_launch_description``."""


def load_python_launch_file_as_module(path: Path | str) -> ModuleType:
    """Run the file as a module that nobody else can import.

    Raises:
        InvalidPythonLaunchFileError: it raised; names file and line.
    """
    path = Path(path)
    loader = SourceFileLoader(f"navette_launch_file_{abs(hash(path))}", str(path))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None, "a loader that is given makes a spec"
    module = module_from_spec(spec)
    writes_bytecode, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        loader.exec_module(module)
    except Exception as error:  # the file's own code: anything can come out of it
        raise _error(path, error) from error
    finally:
        sys.dont_write_bytecode = writes_bytecode
    return module


def get_launch_description_from_python_launch_file(
    launch_file_path: Path | str,
) -> LaunchDescription:
    """What the file's ``generate_launch_description()`` returns.

    Raises:
        InvalidPythonLaunchFileError: there is none, it raised, or it returned
            something else.
    """
    path = Path(launch_file_path)
    module = load_python_launch_file_as_module(path)
    function: Any = getattr(module, _FUNCTION, None)
    if function is None:
        raise InvalidPythonLaunchFileError(f"{path}: has no {_FUNCTION}()")
    try:
        description = function()
    except Exception as error:  # the file's own code, as above
        raise _error(path, error) from error
    if not isinstance(description, LaunchDescription):
        raise InvalidPythonLaunchFileError(
            f"{path}: {_FUNCTION}() returned {description!r}; wanted a "
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
    """A launch file in Python."""

    def __init__(self, launch_file_path: Any) -> None:
        super().__init__(None, launch_file_path, "interpreted python launch file")

    def read(self, path: Path) -> LaunchDescription:
        return get_launch_description_from_python_launch_file(path)
