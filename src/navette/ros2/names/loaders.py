"""Loaders of the modules that have ROS 2's names and Navette's contents."""

import importlib
import re
from abc import abstractmethod
from functools import cache
from importlib.abc import Loader
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

from navette.msgs import get_interface
from navette.msgs.lazy import module_contents
from navette.msgs.registry import KINDS, interface_names
from navette.ros2.names.rclpy_names import rclpy_modules


class Ros2Loader(Loader):
    """Loader of one module; reports the existing names when a program needs another.

    Every module is a package for Python. So ``from rclpy.qos import X`` looks for a
    submodule ``X`` if the module has no such name, and the error of that search can
    list the names that exist.

    Args:
        name: ROS 2's name of the module.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def spec(self) -> ModuleSpec:
        return ModuleSpec(self.name, self, is_package=True)

    def find_child(self, fullname: str) -> ModuleSpec:
        """Return the spec of a submodule.

        Raises:
            ModuleNotFoundError: lists the names of this module.
        """
        child = self.child(fullname.rpartition(".")[2])
        if child is not None:
            return child.spec()
        # Without the argument name=: Python replaces an error that carries the name in
        # a `from … import` by its own, which lists nothing.
        raise ModuleNotFoundError(self.missing(fullname.rpartition(".")[2]))

    def missing(self, name: str) -> str:
        """Return the text of the error for a name that does not exist."""
        names = ", ".join(sorted(self.contents())) or "nothing"
        return (
            f"Navette has no {self.name}.{name}; {self.name} has {names}. If ROS 2 has "
            "this name, the program needs a part of ROS 2 that Navette does not provide"
        )

    @abstractmethod
    def child(self, name: str) -> "Ros2Loader | None":
        """Return the loader of a submodule, None for an unknown submodule."""

    @abstractmethod
    def contents(self) -> list[str]:
        """Return the public names of the module, submodules included."""


class _LazyLoader(Ros2Loader):
    """Loader of a module whose names and submodules are loaded when first used."""

    @abstractmethod
    def names(self) -> list[str]:
        """Return the public names of the module without submodules."""

    @abstractmethod
    def submodules(self) -> frozenset[str]: ...

    @abstractmethod
    def value(self, name: str) -> Any:
        """Return what one of :meth:`names` stands for."""

    def exec_module(self, module: ModuleType) -> None:
        def get(name: str) -> Any:
            if name in names:
                namespace[name] = self.value(name)
                return namespace[name]
            # rclpy's modules import each other, so that programs reach
            # `rclpy.time.Time` after a plain `import rclpy`.
            if name in self.submodules():
                return importlib.import_module(f"{self.name}.{name}")
            raise AttributeError(self.missing(name))

        namespace, names = vars(module), frozenset(self.names())
        namespace.update(
            __all__=sorted(names), __getattr__=get, __dir__=lambda: self.contents()
        )

    def contents(self) -> list[str]:
        names = {*self.names(), *self.submodules()}
        return sorted(name for name in names if not name.startswith("_"))


class RclpyLoader(_LazyLoader):
    """Loader of rclpy and its submodules from the table of their names."""

    def names(self) -> list[str]:
        return list(rclpy_modules()[self.name])

    def submodules(self) -> frozenset[str]:
        start = f"{self.name}."
        rest = (m.removeprefix(start) for m in rclpy_modules() if m.startswith(start))
        return frozenset(name for name in rest if "." not in name)

    def value(self, name: str) -> Any:
        place = rclpy_modules()[self.name][name]
        return getattr(importlib.import_module(place.module), place.attribute)

    def child(self, name: str) -> Ros2Loader | None:
        is_module = name in self.submodules()
        return RclpyLoader(f"{self.name}.{name}") if is_module else None


class _PackageModule(ModuleType):
    """Module whose names stay when a submodule of the same name is imported.

    ``launch_ros.utilities.evaluate_parameters`` is a module and its function.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        is_taken = isinstance(value, ModuleType) and name in vars(self)["__all__"]
        if not is_taken:
            super().__setattr__(name, value)


class PackageLoader(_LazyLoader):
    """Loader of a package of ``navette.ros2.packages`` under ROS 2's name.

    Args:
        name: ROS 2's name of the module.
        alias_of: Navette's.
    """

    def __init__(self, name: str, alias_of: str) -> None:
        super().__init__(name)
        self._alias_of = alias_of
        self._real = ModuleType(alias_of)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        # Python lists the module after this call; then other threads can import its
        # submodules, which need the contents.
        self._real = importlib.import_module(self._alias_of)
        return _PackageModule(self.name)

    def exec_module(self, module: ModuleType) -> None:
        module.__doc__, module.__file__ = self._real.__doc__, self._real.__file__
        super().exec_module(module)

    def names(self) -> list[str]:
        # A submodule may have the name of what its package takes from it.
        hidden = {
            name
            for name in self.submodules()
            if isinstance(getattr(self._real, name, None), ModuleType)
        }
        return sorted(set(_public_names(self._real)) - hidden)

    def submodules(self) -> frozenset[str]:
        path = Path(getattr(self._real, "__file__", None) or "")
        return modules_in(path.parent) if path.name == "__init__.py" else frozenset()

    def value(self, name: str) -> Any:
        return getattr(self._real, name)

    def child(self, name: str) -> Ros2Loader | None:
        if name in self.submodules():
            return PackageLoader(f"{self.name}.{name}", f"{self._alias_of}.{name}")
        other = getattr(self._real, name, None)  # a module that has another name here
        if isinstance(other, ModuleType):
            return PackageLoader(f"{self.name}.{name}", other.__name__)
        if self._has_module_of(name):
            return PackageLoader(f"{self.name}.{name}", self._alias_of)
        return None

    def _has_module_of(self, name: str) -> bool:
        """Whether ROS 2 keeps something of this package in a module of that name.

        In launch, launch_ros and tf2_ros each class has one:
        ``launch.actions.opaque_function``. Small packages have one of their own name:
        ``laser_geometry.laser_geometry``.
        """
        if name == self.name:
            return True
        if self.name.partition(".")[0] not in _MODULE_PER_CLASS:
            return False
        start = name.replace("_", "")
        words = [each.replace("_", "").lower() for each in _public_names(self._real)]
        # `shutdown_action` has Shutdown.
        start = start.removesuffix("action")
        return name.islower() and any(word.startswith(start) for word in words)


class InterfacePackageLoader(Ros2Loader):
    """Loader of a package with the modules ``msg``, ``srv`` and ``action`` it has."""

    def exec_module(self, module: ModuleType) -> None:
        module.__doc__ = f"Interfaces of {self.name}."

    def child(self, name: str) -> Ros2Loader | None:
        if name not in self.contents():
            return None
        return InterfaceLoader(f"{self.name}.{name}")

    def contents(self) -> list[str]:
        return [kind for kind in KINDS if interface_names(self.name, kind)]


class InterfaceLoader(Ros2Loader):
    """Loader of a module such as ``std_msgs.msg``, whose classes are made when used."""

    def exec_module(self, module: ModuleType) -> None:
        namespace = vars(module)
        get, listed, names = module_contents(namespace)
        namespace.update(__getattr__=get, __dir__=listed, __all__=names)

    def child(self, name: str) -> Ros2Loader | None:
        for each in self.contents():
            if name == f"_{_module_name(each)}":
                return DefinitionLoader(f"{self.name}.{name}", each)
        return None

    def contents(self) -> list[str]:
        package, kind = self.name.split(".")
        return interface_names(package, kind)


class DefinitionLoader(Ros2Loader):
    """Loader of ``std_msgs.msg._string``: the classes of one definition.

    ROS 2 generates such modules, and editors import from them.
    """

    def __init__(self, name: str, interface: str) -> None:
        super().__init__(name)
        self._interface = interface

    def exec_module(self, module: ModuleType) -> None:
        vars(module).update(self._classes())

    def child(self, name: str) -> Ros2Loader | None:
        return None

    def contents(self) -> list[str]:
        return list(self._classes())

    def _classes(self) -> dict[str, Any]:
        package, kind, _ = self.name.split(".")
        main = get_interface(f"{package}/{kind}/{self._interface}")
        scopes = [main, getattr(main, "Impl", None)]
        parts = [each for scope in scopes for each in vars(scope or object).values()]
        named = [part for part in parts if isinstance(part, type)]
        return {each.__name__: each for each in (main, *named) if each is not type}


def _module_name(interface: str) -> str:
    """Return the name of the module of an interface: ``LaserScan``: ``laser_scan``."""
    spaced = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", interface)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", spaced).lower()


_MODULE_PER_CLASS = (
    "launch",
    "launch_pytest",
    "launch_ros",
    "launch_testing",
    "tf2_ros",
)


@cache
def modules_in(folder: Path) -> frozenset[str]:
    """Return the names of the modules and packages in a folder of Navette."""
    return frozenset(
        path.stem
        for path in folder.iterdir()
        if path.stem.isidentifier()
        and not path.stem.startswith("__")
        and (path.suffix == ".py" or (path / "__init__.py").is_file())
    )


def _public_names(module: ModuleType) -> list[str]:
    listed = getattr(module, "__all__", None)
    if listed is not None:
        return list(listed)
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and not isinstance(value, ModuleType)
    ]
