"""Load node classes by name."""

import importlib
import inspect
import sys
from pathlib import Path
from types import ModuleType

from navette.errors import InvalidValueError, UnknownNameError
from navette.ros2.names.hook import install
from navette.ros2.names.program import load_file, search_path
from navette.runtime import Node

_FORMS = "expected MODULE:Class or FILE.py:Class"


def load_node_class(target: str) -> type[Node]:
    """Return the class that ``MODULE:Class`` or ``FILE.py:Class`` names.

    Installs the import hook, so that the module may import rclpy.

    Raises:
        InvalidValueError: the target has another form.
        UnknownNameError: the file, module or node class does not exist.
    """
    place, colon, name = target.rpartition(":")
    if not colon or not name.isidentifier() or not place:
        raise InvalidValueError(f"{target!r}: {_FORMS}")
    install(instead_of_ros=True)
    module = _load(place)
    found = getattr(module, name, None)
    if inspect.isclass(found) and issubclass(found, Node):
        return found
    classes = [
        each
        for each, value in vars(module).items()
        if inspect.isclass(value)
        and issubclass(value, Node)
        and value.__module__ == module.__name__
    ]
    raise UnknownNameError.of(f"node class in {place}", name, classes)


def _load(place: str) -> ModuleType:
    if place.endswith(".py"):
        path = Path(place)
        if not path.is_file():
            raise UnknownNameError(f"{path}: no such file")
        _put_on_path(search_path(path.resolve()))
        return load_file(path, path.stem)
    _put_on_path((Path.cwd(),))
    try:
        return importlib.import_module(place)
    except ModuleNotFoundError as error:
        raise UnknownNameError(
            f"module {place!r} cannot be imported: {error}"
        ) from None


def _put_on_path(folders: tuple[Path, ...]) -> None:
    for folder in map(str, folders):
        if folder not in sys.path:
            sys.path.insert(0, folder)
