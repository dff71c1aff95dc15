"""Import hook: ``import rclpy``, ``from std_msgs.msg import String`` load Navette.

Importing Navette installs nothing; ``navette run`` and callers of :func:`install` do.

Which code a name stands for, first match first:

1. A module beside the program (in the first folder of ``sys.path``), as in Python.
2. ``rclpy`` and the launch packages: Navette's, because Navette runs what they make.
   Where ROS 2 is installed, :func:`install` raises unless ``instead_of_ros`` is given.
3. Other packages of ROS 2 (``tf_transformations``, ``cv_bridge``, …): the one that is
   installed or on ``PYTHONPATH``, else Navette's.
4. ``msg``, ``srv`` and ``action`` of an interface package: Navette's classes, made from
   the ``.msg``, ``.srv`` and ``.action`` files; its nodes accept no others. Definitions
   of a workspace precede Navette's. Further modules of such a package come from where
   it is installed.

With ``instead_of_ros``, packages that belong to the ROS 2 installation count as not
installed: they call rclpy's C extension, and Navette's nodes have no handles for it.
Packages from elsewhere, as from pip, still come before Navette's.
"""

import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import ModuleType

from navette.errors import NavetteError
from navette.msgs import packages
from navette.msgs.registry import KINDS
from navette.ros2.names.loaders import (
    InterfaceLoader,
    InterfacePackageLoader,
    PackageLoader,
    RclpyLoader,
    Ros2Loader,
    modules_in,
)

#: Packages whose objects Navette itself runs.
_ALWAYS_NAVETTE = frozenset(
    {
        "rclpy",
        "launch",
        "launch_pytest",
        "launch_ros",
        "launch_testing",
        "launch_testing_ros",
        "launch_xml",
        "launch_yaml",
    }
)
_PACKAGES = modules_in(Path(__file__).parent.parent / "packages")
#: ROS 2's packages that Navette provides, interface packages apart.
PROVIDED = frozenset({"rclpy", *_PACKAGES})


class RealRosError(NavetteError):
    """ROS 2 is installed, and Navette was not asked to replace it."""


def installed_rclpy() -> Path | None:
    """Return the folder of an installed rclpy that is not Navette's, or None."""
    spec = PathFinder.find_spec("rclpy")
    if spec is None or spec.origin is None:
        return None
    return Path(spec.origin).parent


def is_installed() -> bool:
    """Whether ROS 2's module names load Navette now."""
    return any(isinstance(finder, Ros2Finder) for finder in sys.meta_path)


def install(*, instead_of_ros: bool = False) -> None:
    """Make ROS 2's module names load Navette; a second call changes nothing.

    Args:
        instead_of_ros: also where ROS 2 is installed.

    Raises:
        RealRosError: ROS 2 is installed, or its rclpy is imported already.
    """
    if is_installed():
        return
    real = installed_rclpy()
    if real is not None and not instead_of_ros:
        raise RealRosError(
            f"ROS 2's rclpy is installed at {real}; to use Navette's instead, call "
            "install(instead_of_ros=True)"
        )
    imported = sys.modules.get("rclpy")
    if imported is not None:
        raise RealRosError(
            "rclpy is imported already from "
            f"{getattr(imported, '__file__', 'an unknown file')}; call install() "
            "before the first import of rclpy"
        )
    sys.meta_path.insert(0, Ros2Finder())


def uninstall() -> None:
    """Remove the hook and the modules that were imported through it."""
    for finder in [f for f in sys.meta_path if isinstance(f, Ros2Finder)]:
        sys.meta_path.remove(finder)
    for name, module in list(sys.modules.items()):
        if isinstance(getattr(module, "__loader__", None), Ros2Loader):
            del sys.modules[name]


def replaced_packages() -> dict[str, Path]:
    """Return the packages that are used instead of Navette's, with their files."""
    found = {name: _installed_file(name) for name in sorted(PROVIDED - _ALWAYS_NAVETTE)}
    return {name: file for name, file in found.items() if file is not None}


class Ros2Finder(MetaPathFinder):
    """Finder of ROS 2's packages and of the interface packages of the registry."""

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None = None,
        target: ModuleType | None = None,
    ) -> ModuleSpec | None:
        top, _, rest = fullname.partition(".")
        if not rest:
            loader = _top_loader(top)
            return None if loader is None else loader.spec()
        parent = sys.modules.get(fullname.rpartition(".")[0])
        parent_loader = getattr(parent, "__loader__", None)
        if isinstance(parent_loader, Ros2Loader):
            return parent_loader.find_child(fullname)
        if rest in KINDS and _is_interface_package(top):
            return InterfaceLoader(fullname).spec()
        return None


def _top_loader(name: str) -> Ros2Loader | None:
    if name not in PROVIDED and not _is_interface_package(name):
        return None
    if name in _ALWAYS_NAVETTE:
        other = _file_of(PathFinder.find_spec(name, sys.path[:1]))
    else:
        other = _installed_file(name)
    if other is not None:
        return None
    if name == "rclpy":
        return RclpyLoader(name)
    if name in _PACKAGES:
        return PackageLoader(name, f"navette.ros2.packages.{name}")
    return InterfacePackageLoader(name)


def _installed_file(name: str) -> Path | None:
    """Return the file of a package that is installed apart from ROS 2, or None."""
    for finder in sys.meta_path:
        if isinstance(finder, Ros2Finder):
            continue
        file = _file_of(finder.find_spec(name, None))
        if file is not None:
            return None if _belongs_to_ros(name, file) else file
    return None


def _belongs_to_ros(name: str, file: Path) -> bool:
    """Whether a package was installed with rclpy: has its package.xml in one prefix."""
    rclpy = installed_rclpy()
    if rclpy is None:
        return False
    return any(
        prefix in file.parents and (prefix / "share" / name / "package.xml").is_file()
        for prefix in rclpy.parents
    )


def _file_of(spec: ModuleSpec | None) -> Path | None:
    """Return the file of a module; None for a folder without ``__init__.py``."""
    if spec is None or spec.loader is None or spec.origin is None:
        return None
    return Path(spec.origin)


def _is_interface_package(name: str) -> bool:
    return name.isidentifier() and name in packages()
