"""Packages of a workspace, found by folder without a build step, and made new."""

from navette.packages.create import create_package
from navette.packages.executables import Executable
from navette.packages.finding import (
    PackageNotFoundError,
    activate,
    find_package,
    find_packages,
    search_roots,
)
from navette.packages.manifest import Manifest, read_manifest
from navette.packages.package import Origin, Package

__all__ = [
    "Executable",
    "Manifest",
    "Origin",
    "Package",
    "PackageNotFoundError",
    "activate",
    "create_package",
    "find_package",
    "find_packages",
    "read_manifest",
    "search_roots",
]
