"""The import hook: ``import rclpy``, ``from std_msgs.msg import String`` → Navette.

As if a folder with these modules stood on Python's path right behind the program's
own. Nothing is installed by importing Navette; ``navette run`` does it, and whoever
calls :func:`install`.
"""

import importlib
import sys
from collections.abc import Sequence
from functools import cache
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import ModuleType
from typing import Any

from navette.errors import NavetteError
from navette.msgs import packages
from navette.msgs.lazy import module_contents
from navette.msgs.registry import KINDS, interface_names


@cache
def modules_in(folder: Path) -> frozenset[str]:
    """Names of the modules and packages in a folder of Navette."""
    return frozenset(
        path.stem
        for path in folder.iterdir()
        if path.stem.isidentifier()
        and not path.stem.startswith("__")
        and (path.suffix == ".py" or (path / "__init__.py").is_file())
    )


#: ROS 2's name of a package → Navette's.
PROVIDED = {
    "rclpy": "navette.ros2.names.rclpy",
    **{
        name: f"navette.ros2.packages.{name}"
        for name in modules_in(Path(__file__).parent.parent / "packages")
    },
}


class RealRosError(NavetteError):
    """ROS 2 itself is there; Navette does not take its place unasked."""


def installed_rclpy() -> Path | None:
    """Where a real rclpy would be imported from, or None."""
    spec = PathFinder.find_spec("rclpy")
    if spec is None or spec.origin is None:
        return None
    return Path(spec.origin).parent


def is_installed() -> bool:
    """Whether ROS 2's names mean Navette's modules now."""
    return any(isinstance(finder, Ros2Finder) for finder in sys.meta_path)


def install(*, instead_of_ros: bool = False) -> None:
    """Let ROS 2's module names mean Navette's modules; a second call does nothing.

    Args:
        instead_of_ros: also where ROS 2 is installed.

    Raises:
        RealRosError: it is installed, or was imported already.
    """
    if is_installed():
        return
    real = installed_rclpy()
    if real is not None and not instead_of_ros:
        raise RealRosError(
            f"ROS 2's rclpy is installed at {real}; ask for Navette's with "
            "install(instead_of_ros=True)"
        )
    imported = sys.modules.get("rclpy")
    if imported is not None:
        raise RealRosError(
            "rclpy was imported already from "
            f"{getattr(imported, '__file__', 'nowhere')}; install before that"
        )
    sys.meta_path.insert(0, Ros2Finder())


def uninstall() -> None:
    """Take the names back; what was imported through them is forgotten."""
    for finder in [f for f in sys.meta_path if isinstance(f, Ros2Finder)]:
        sys.meta_path.remove(finder)
    for name, module in list(sys.modules.items()):
        if isinstance(getattr(module, "__loader__", None), _NavetteLoader):
            del sys.modules[name]


class Ros2Finder(MetaPathFinder):
    """Finds ROS 2's modules and, in Navette's registry, interface packages."""

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None = None,
        target: ModuleType | None = None,
    ) -> ModuleSpec | None:
        top, _, rest = fullname.partition(".")
        if not rest:
            return self._find_top(top)
        parent = sys.modules.get(fullname.rpartition(".")[0])
        loader = getattr(parent, "__loader__", None)
        if isinstance(loader, _NavetteLoader):
            return loader.find_child(fullname)
        if rest in KINDS and _is_interface_package(top):
            return _spec(fullname, InterfaceLoader(fullname))
        return None

    def _find_top(self, name: str) -> ModuleSpec | None:
        if name in PROVIDED:
            if _is_regular(name, sys.path[:1]):  # the program's own folder goes first
                return None
            return _spec(name, AliasLoader(name, PROVIDED[name]))
        if _is_interface_package(name) and not _is_regular(name, sys.path):
            return _spec(name, InterfacePackageLoader(name))
        return None


class _NavetteLoader:
    """Marks modules that stand for ROS 2's; helps those who ask for what is missing.

    Every module is a package as far as Python knows: so a ``from rclpy.qos import X``
    that finds no ``X`` asks for a submodule, and the answer can say what there is.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def find_child(self, fullname: str) -> ModuleSpec:
        """The spec of a submodule.

        Raises:
            ModuleNotFoundError: tells what the module has.
        """
        # Without the name=: Python passes over the error if it bears the name that a
        # `from … import` asked for, and words its own.
        raise ModuleNotFoundError(self.missing(fullname.rpartition(".")[2]))

    def missing(self, wanted: str) -> str:
        """What to say of a name that is not there."""
        has = ", ".join(sorted(self.contents())) or "nothing"
        return (
            f"Navette has no {self.name}.{wanted}; {self.name} has {has}. If ROS 2 has "
            f"it, the program needs a part of ROS 2 that Navette has not got"
        )

    def contents(self) -> list[str]:
        """Public names of the module, submodules included."""
        return [n for n in dir(sys.modules[self.name]) if not n.startswith("_")]


class AliasLoader(_NavetteLoader, Loader):
    """Makes a module that hands out the names of one of Navette's.

    Args:
        name: ROS 2's name of the module.
        alias_of: Navette's.
    """

    def __init__(self, name: str, alias_of: str) -> None:
        super().__init__(name)
        self._alias_of = alias_of
        self._real = ModuleType(alias_of)

    def create_module(self, spec: ModuleSpec) -> None:
        # Before Python lists the new module: from then on another thread may ask for
        # its submodules.
        self._real = importlib.import_module(self._alias_of)

    def exec_module(self, module: ModuleType) -> None:
        real = self._real
        names = sorted(set(_public_names(real)) - self._submodules())
        module.__doc__, module.__file__ = real.__doc__, real.__file__
        vars(module).update({name: getattr(real, name) for name in names})
        vars(module).update(__all__=names, __getattr__=self._attribute)

    def find_child(self, fullname: str) -> ModuleSpec:
        child = fullname.rpartition(".")[2]
        if child in self._submodules():
            return _spec(fullname, AliasLoader(fullname, f"{self._alias_of}.{child}"))
        if self._has_module_of(child):
            return _spec(fullname, AliasLoader(fullname, self._alias_of))
        return super().find_child(fullname)

    def _has_module_of(self, name: str) -> bool:
        """Whether ROS 2 keeps something of this package in a module of that name.

        In launch and launch_ros each class has one: ``launch.actions.opaque_function``.
        """
        if self.name.partition(".")[0] not in ("launch", "launch_ros"):
            return False
        start = name.replace("_", "")
        return name.islower() and any(
            each.lower().startswith(start) for each in _public_names(self._real)
        )

    def contents(self) -> list[str]:
        names = {*_public_names(self._real), *self._submodules()}
        return sorted(name for name in names if not name.startswith("_"))

    def _submodules(self) -> frozenset[str]:
        path = Path(getattr(self._real, "__file__", None) or "")
        return modules_in(path.parent) if path.name == "__init__.py" else frozenset()

    def _attribute(self, name: str) -> Any:
        # rclpy's modules import each other, so that programs reach
        # `rclpy.time.Time` after a plain `import rclpy`.
        if name in self._submodules():
            return importlib.import_module(f"{self.name}.{name}")
        raise AttributeError(self.missing(name))


class InterfacePackageLoader(_NavetteLoader, Loader):
    """A package with ``msg``, ``srv`` and ``action``, as far as it has any."""

    def exec_module(self, module: ModuleType) -> None:
        module.__doc__ = f"Interfaces of {self.name}."

    def find_child(self, fullname: str) -> ModuleSpec:
        kind = fullname.rpartition(".")[2]
        if kind in KINDS and interface_names(self.name, kind):
            return _spec(fullname, InterfaceLoader(fullname))
        return super().find_child(fullname)

    def contents(self) -> list[str]:
        return [kind for kind in KINDS if interface_names(self.name, kind)]


class InterfaceLoader(_NavetteLoader, Loader):
    """``std_msgs.msg``: classes are made on first use, the same as Navette's."""

    def exec_module(self, module: ModuleType) -> None:
        namespace = vars(module)
        get, listed, names = module_contents(namespace)
        namespace.update(__getattr__=get, __dir__=listed, __all__=names)

    def contents(self) -> list[str]:
        package, kind = self.name.split(".")
        return interface_names(package, kind)


def _public_names(module: ModuleType) -> list[str]:
    listed = getattr(module, "__all__", None)
    if listed is not None:
        return list(listed)
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and not isinstance(value, ModuleType)
    ]


def _spec(fullname: str, loader: Loader) -> ModuleSpec:
    return ModuleSpec(fullname, loader, is_package=True)


def _is_interface_package(name: str) -> bool:
    return name.isidentifier() and name in packages()


def _is_regular(name: str, path: list[str]) -> bool:
    """Whether Python finds a module of that name there; a mere folder is none."""
    spec = PathFinder.find_spec(name, path)
    return spec is not None and spec.loader is not None and spec.origin is not None
