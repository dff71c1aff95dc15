"""ament_index_python.packages: prefixes and share directories of packages.

For a package of the workspace both are its source folder; no build is required.
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
    return {name: str(package.prefix) for name, package in find_packages().items()}


def get_package_prefix(package_name: str) -> str:
    """Return the prefix of an installed package, or the folder of a source package.

    Raises:
        PackageNotFoundError: the package does not exist.
        ValueError: the name is not valid.
    """
    return str(find_package(package_name).prefix)


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """Return the share directory as text; raise as :func:`get_package_prefix`."""
    return str(_share(package_name, warn=print_warning))


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """Return the share directory; raise as :func:`get_package_prefix`."""
    return _share(package_name, warn=print_warning)


def _share(name: str, *, warn: bool) -> Path:
    share = find_package(name).share
    if warn and not share.exists():
        warnings.warn(
            f"Share directory for {name} ({share}) does not exist.", stacklevel=3
        )
    return share
