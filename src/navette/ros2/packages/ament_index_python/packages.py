"""ament_index_python.packages: where packages and their files are.

A package of the workspace is found in its source folder, with nothing built: that
folder is its share directory and its prefix.
"""

import warnings
from pathlib import Path

from navette.ros2.workspace import PackageNotFoundError, find_package, find_packages

__all__ = [
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
]


def get_packages_with_prefixes() -> dict[str, str]:
    """Names of all packages → their prefixes."""
    return {name: str(package.prefix) for name, package in find_packages().items()}


def get_package_prefix(package_name: str) -> str:
    """The prefix a package is installed in, its folder if it is a source.

    Raises:
        PackageNotFoundError: nobody has a package of that name.
        ValueError: no package can have that name.
    """
    return str(find_package(package_name).prefix)


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """The folder of a package's files, as text.

    Raises:
        PackageNotFoundError: nobody has a package of that name.
        ValueError: no package can have that name.
    """
    return str(_share(package_name, warn=print_warning))


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """The folder of a package's files; raises as the other."""
    return _share(package_name, warn=print_warning)


def _share(name: str, *, warn: bool) -> Path:
    share = find_package(name).share
    if warn and not share.exists():
        warnings.warn(
            f"Share directory for {name} ({share}) does not exist.", stacklevel=3
        )
    return share
