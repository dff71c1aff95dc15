"""Packages of a workspace: search without a build step."""

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
    "Origin",
    "Package",
    "PackageNotFoundError",
    "activate",
    "find_package",
    "find_packages",
    "read_manifest",
    "search_roots",
]
