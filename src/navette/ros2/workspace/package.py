"""A package that was found: where it is and what is in it."""

from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from navette.ros2.workspace.executables import (
    Executable,
    built_in_executables,
    installed_executables,
    source_executables,
)
from navette.ros2.workspace.manifest import FILE_NAME, Manifest, read_manifest
from navette.ros2.workspace.share import share_directory

INTERFACE_KINDS = ("msg", "srv", "action")


class Origin(Enum):
    """How a package came to be there."""

    SOURCE = "source"  # a folder with package.xml in a workspace
    INSTALLED = "installed"  # share/<name> below a prefix, built by colcon or pip
    BUILT_IN = "built-in"  # part of Navette


@dataclass(frozen=True, slots=True)
class Package:
    """Found by :func:`find_package`.

    Attributes:
        folder: where it lies.
    """

    name: str
    folder: Path
    origin: Origin

    @property
    def share(self) -> Path:
        """The folder of its files: launch/, config/, msg/, ….

        Raises:
            FileFormatError: setup.py is broken.
        """
        if self.origin is Origin.SOURCE:
            return share_directory(self.name, self.folder)
        return self.folder

    @property
    def prefix(self) -> Path:
        """The prefix it is installed in; where nothing was installed, its folder."""
        if self.origin is Origin.INSTALLED:
            return self.folder.parent.parent
        return self.folder

    @property
    def has_interfaces(self) -> bool:
        """Whether it defines messages, services or actions."""
        return any(
            next((self.folder / kind).glob(f"*.{kind}"), None)
            for kind in INTERFACE_KINDS
        )

    @property
    def python_path(self) -> Path | None:
        """The folder that its Python modules are imported from, if it is a source."""
        return self.folder if self.origin is Origin.SOURCE else None

    def manifest(self) -> Manifest:
        """Read its package.xml.

        Raises:
            FileFormatError: broken.
        """
        return read_manifest(self.folder / FILE_NAME)

    def executables(self) -> tuple[Executable, ...]:
        """What ``navette run PACKAGE EXECUTABLE`` can run, sorted by name.

        Raises:
            FileFormatError: setup.py, setup.cfg or pyproject.toml is broken.
        """
        if self.origin is Origin.SOURCE:
            return source_executables(self.name, self.folder)
        if self.origin is Origin.INSTALLED:
            return installed_executables(self.name, self.prefix / "lib" / self.name)
        return built_in_executables(self.name)

    def executable(self, name: str) -> Executable:
        """One of them, by name.

        Raises:
            UnknownNameError: there is none of that name; lists those known.
        """
        return Executable.named(name, self.name, self.executables())
