"""Packages of a workspace: search without a build step, and creation."""

from navette.ros2.workspace.create import (
    BUILD_TYPES,
    PackageAbout,
    create_bare_package,
    create_package,
)
from navette.ros2.workspace.finding import (
    PackageNotFoundError,
    activate,
    find_package,
    find_packages,
    search_roots,
)
from navette.ros2.workspace.manifest import read_manifest
from navette.ros2.workspace.package import Origin, Package

__all__ = [
    "BUILD_TYPES",
    "Origin",
    "Package",
    "PackageAbout",
    "PackageNotFoundError",
    "activate",
    "create_bare_package",
    "create_package",
    "find_package",
    "find_packages",
    "read_manifest",
    "search_roots",
]
