"""Load node classes by name."""

import inspect
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from types import ModuleType

from navette.errors import InvalidValueError, UnknownNameError
from navette.params.plugins.loading import load_module, put_on_path
from navette.ros2.names.hook import install
from navette.ros2.names.program import search_path
from navette.runtime import Context, Node

_FORMS = "expected MODULE:Class or FILE.py:Class"


def load_node_class(target: str) -> type[Node]:
    """Return the class that ``MODULE:Class`` or ``FILE.py:Class`` names.

    ``FILE.py`` is enough if the file has one class of nodes.

    Installs the import hook, so that the module may import rclpy.

    Raises:
        InvalidValueError: the target has another form, or it raised while it was
            imported.
        UnknownNameError: the file, module or node class does not exist.
    """
    place, colon, name = target.rpartition(":")
    if target.endswith(".py"):
        install(instead_of_ros=True)
        return _only_class(target, _load(target))
    if not colon or not name.isidentifier() or not place:
        raise InvalidValueError(f"{target!r}: {_FORMS}")
    install(instead_of_ros=True)
    module = _load(place)
    found = getattr(module, name, None)
    if inspect.isclass(found) and issubclass(found, Node):
        return found
    classes = [each.__name__ for each in _classes(module)]
    raise UnknownNameError.of(f"node class in {place}", name, classes)


def _only_class(target: str, module: ModuleType) -> type[Node]:
    classes = _classes(module)
    if len(classes) == 1:
        return classes[0]
    names = ", ".join(each.__name__ for each in classes) or "none"
    raise InvalidValueError(
        f"{target}: expected one class of nodes, or {target}:NAME; there are: {names}"
    )


def _classes(module: ModuleType) -> list[type[Node]]:
    return [
        value
        for value in vars(module).values()
        if inspect.isclass(value)
        and issubclass(value, Node)
        and value.__module__ == module.__name__
    ]


def node_makers(
    replacements: Mapping[str, str],
) -> dict[str, Callable[[Context], Node]]:
    """Return what makes the nodes that replace others, from name → target.

    Raises:
        InvalidValueError, UnknownNameError: as :func:`load_node_class`.
    """
    return {
        name: partial(_make, load_node_class(target))
        for name, target in replacements.items()
    }


def _make(kind: Callable[[], Node], context: Context) -> Node:
    """Make a node of a program, which takes the default context."""
    return kind()


def _load(place: str) -> ModuleType:
    if place.endswith(".py"):
        for folder in search_path(Path(place).resolve()):
            put_on_path(folder)
    return load_module(place)
