"""A package: its folders, manifest and executables."""

from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from navette.errors import UnknownNameError
from navette.ros2.workspace.executables import (
    PackageExecutable,
    built_in_executables,
    installed_executables,
    source_executables,
)
from navette.ros2.workspace.manifest import FILE_NAME, Manifest, read_manifest
from navette.ros2.workspace.share import share_directory

INTERFACE_KINDS = ("msg", "srv", "action")


class Origin(Enum):
    """Kind of a package's location."""

    SOURCE = "source"  # a folder with package.xml in a workspace
    INSTALLED = "installed"  # share/<name> below a prefix, built by colcon or pip
    BUILT_IN = "built-in"  # part of Navette


@dataclass(frozen=True, slots=True)
class Package:
    """A package, as :func:`find_package` returns it.

    Attributes:
        folder: source folder, share directory, or folder of definitions.
    """

    name: str
    folder: Path
    origin: Origin

    @property
    def share(self) -> Path:
        """The share directory with launch/, config/, msg/, ….

        Raises:
            FileFormatError: setup.py is not valid Python.
        """
        if self.origin is Origin.SOURCE:
            return share_directory(self.name, self.folder)
        return self.folder

    @property
    def prefix(self) -> Path:
        """The prefix of an installed package; of another one its folder."""
        if self.origin is Origin.INSTALLED:
            return self.folder.parent.parent
        return self.folder

    @property
    def has_interfaces(self) -> bool:
        """Whether the package defines messages, services or actions."""
        return any(
            next((self.folder / kind).glob(f"*.{kind}"), None)
            for kind in INTERFACE_KINDS
        )

    @property
    def python_path(self) -> Path | None:
        """The import folder of a source package's Python modules, else None."""
        return self.folder if self.origin is Origin.SOURCE else None

    def manifest(self) -> Manifest:
        """Read package.xml.

        Raises:
            FileFormatError: the file is not valid.
        """
        return read_manifest(self.folder / FILE_NAME)

    def executables(self) -> tuple[PackageExecutable, ...]:
        """Return the programs for ``navette run PACKAGE EXECUTABLE``, sorted by name.

        Navette's programs replace those of C++ packages: in a workspace with the
        sources of turtlesim, turtlesim_node is Navette's.

        Raises:
            FileFormatError: setup.py, setup.cfg or pyproject.toml is not valid.
        """
        own: tuple[PackageExecutable, ...] = ()
        if self.origin is Origin.SOURCE:
            own = source_executables(self.name, self.folder)
        elif self.origin is Origin.INSTALLED:
            own = installed_executables(self.name, self.prefix / "lib" / self.name)
        names = {each.name for each in own}
        added = built_in_executables(self.name)
        return (*own, *(each for each in added if each.name not in names))

    def executable(self, name: str) -> PackageExecutable:
        """Return one program by name.

        Raises:
            UnknownNameError: unknown name; lists the existing ones.
        """
        known = {each.name: each for each in self.executables()}
        if name not in known:
            raise UnknownNameError.of(f"executable of {self.name}", name, list(known))
        return known[name]
