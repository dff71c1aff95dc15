"""Sources of launch descriptions: Python, XML and YAML files."""

import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.frontend import FORMATS, parse_launch_file
from navette.ros2.packages.launch.launch_context import SCRIPT, LaunchContext
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.substitution import (
    Parts,
    TextSubstitution,
)

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidLaunchFileError",
    "InvalidPythonLaunchFileError",
    "LaunchDescriptionSource",
    "PythonLaunchDescriptionSource",
    "XMLLaunchDescriptionSource",
    "YAMLLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]


class LaunchDescriptionSource:
    """An existing description, or (in subclasses) a file that contains one.

    Args:
        launch_description: the description itself.
        location: path of a file.
        method: kind of source, for messages.
    """

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: Any = SCRIPT,
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description = launch_description
        self._location: Parts = Parts.of(location)
        self.method = method
        self.path: Path | None = None

    @property
    def location(self) -> str:
        """The path as given, or its substitutions until they are known."""
        text = constant_text(self._location)
        if text is not None:
            return text
        return self._location.describe() if self.path is None else str(self.path)

    def read(self, path: Path) -> LaunchDescription:
        """Read a file; overridden by formats."""
        raise InvalidLaunchFileError(f"{path}: unknown format")

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the description; its file is read on first use.

        Raises:
            InvalidLaunchFileError: the file cannot be read.
        """
        if self._description is not None:
            location = constant_text(self._location)
            if self.path is None and location and Path(location).is_file():
                self.path = Path(location).resolve()
        else:
            self._description = self._load(Path(self._location.perform(context)))
        return self._description

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """Return the description, or None if its path depends on the launch."""
        path = constant_text(self._location)
        if self._description is None and path not in (None, SCRIPT):
            self._description = self._load(Path(str(path)))
        return self._description

    def _load(self, path: Path) -> LaunchDescription:
        if not path.is_file():
            raise InvalidLaunchFileError(f"launch file {path} does not exist")
        self.path = path.resolve()
        return self.read(self.path)


def constant_text(location: Parts) -> str | None:
    """Return the text of parts without substitutions, else None."""
    texts = [part.text for part in location if isinstance(part, TextSubstitution)]
    return "".join(texts) if len(texts) == len(location) else None


_FUNCTION = "generate_launch_description"


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """A Python launch file raised, or has no ``generate_launch_description``."""


def load_python_launch_file_as_module(path: Path | str) -> ModuleType:
    """Run the file as a module that is not importable by name.

    Raises:
        InvalidPythonLaunchFileError: the file raised; names the line.
        FileNotFoundError: no such file.
    """
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such launch file")
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
    except Exception as error:  # a user's function may raise anything
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


def get_launch_description_from_any_launch_file(
    launch_file_path: Path | str,
) -> LaunchDescription:
    """Read a ``.py``, ``.xml``, ``.launch``, ``.yaml`` or ``.yml`` file.

    Raises:
        InvalidLaunchFileError: an unknown file ending, or an invalid file.
    """
    path = Path(launch_file_path)
    if path.suffix == ".py":
        return get_launch_description_from_python_launch_file(path)
    if path.suffix in FORMATS:
        return parse_launch_file(path)
    raise InvalidLaunchFileError(
        f"{path}: unknown launch file format; expected a file ending in .py, "
        f"{', '.join(FORMATS)}"
    )


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """Source of a launch file in any format."""

    def __init__(self, launch_file_path: Any) -> None:
        super().__init__(None, launch_file_path, "launch file")

    def read(self, path: Path) -> LaunchDescription:
        return get_launch_description_from_any_launch_file(path)


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """Source of a launch file in XML or YAML."""

    def __init__(self, launch_file_path: Any, **kwargs: Any) -> None:
        super().__init__(None, launch_file_path, "XML or YAML launch file")

    def read(self, path: Path) -> LaunchDescription:
        return parse_launch_file(path)


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Source of an XML launch file with any ending."""

    def read(self, path: Path) -> LaunchDescription:
        return parse_launch_file(path, ".xml")


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """Source of a YAML launch file with any ending."""

    def read(self, path: Path) -> LaunchDescription:
        return parse_launch_file(path, ".yaml")
