"""Search for packages: current workspace, NAVETTE_PATH, installed prefixes.

A source package needs no build or installation: its files are read from the source
folder. Of several packages with one name the first counts, in this order: the current
workspace, NAVETTE_PATH, AMENT_PREFIX_PATH and Python's prefix, Navette itself.
"""

import os
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from navette import msgs
from navette.errors import FileFormatError, InvalidNameError, UnknownNameError
from navette.msgs.registry import DEFINITIONS, prefer_interfaces
from navette.ros2.workspace.executables import PACKAGES_OF_PROGRAMS
from navette.ros2.workspace.manifest import FILE_NAME, is_package_name, read_manifest
from navette.ros2.workspace.package import Origin, Package

#: Environment variable with the folders in which packages are searched.
PATH_VARIABLE = "NAVETTE_PATH"
AMENT_VARIABLE = "AMENT_PREFIX_PATH"

_IGNORE_FILES = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE", "NAVETTE_IGNORE")
_OUTPUT_FOLDERS = ("build", "install", "log", "node_modules", "__pycache__")
_DEPTH = 4  # workspace/src/repository/group/package
_DEPTH_BESIDE = 1  # in a folder that is not a workspace, such as the home folder
_SRC_ABOVE = 3  # maximum depth of a package below the workspace's src


class PackageNotFoundError(UnknownNameError, KeyError):
    """A package of that name does not exist.

    Also a ``KeyError``, as ament_index_python's exception of the same name.
    """

    __str__ = Exception.__str__  # KeyError would quote the text


def find_packages(start: Path | None = None) -> dict[str, Package]:
    """Return all packages by name, sorted.

    Args:
        start: a folder of the workspace; default: the working directory.

    Raises:
        FileFormatError: a package.xml is invalid, or a folder of NAVETTE_PATH does not
            exist.
        InvalidNameError: two packages below one folder have the same name.
    """
    return {each.name: each for each in _first_of_each(_all(start))}


def find_package(name: str, start: Path | None = None) -> Package:
    """Return the package of that name.

    Raises:
        InvalidNameError: the name is not valid.
        PackageNotFoundError: unknown package; lists the searched folders.
    """
    if not is_package_name(name):
        raise InvalidNameError(f"{name!r} is not a valid package name")
    for package in _all(start):
        if package.name == name:
            return package
    places = ", ".join(
        str(root) for root in (*search_roots(start), *installed_prefixes())
    )
    raise PackageNotFoundError(
        f"package {name!r} not found, searching: {places} "
        f"(add folders to {PATH_VARIABLE})"
    )


def search_roots(start: Path | None = None) -> tuple[Path, ...]:
    """Return the folders below which source packages are searched.

    Raises:
        FileFormatError: a folder of NAVETTE_PATH does not exist.
    """
    here = _workspace_root((start or Path.cwd()).resolve())[0]
    return tuple(dict.fromkeys((here, *_named_roots())))


def _named_roots() -> list[Path]:
    named = [Path(each).expanduser() for each in _variable(PATH_VARIABLE)]
    for root in named:
        if not root.is_dir():
            raise FileFormatError(root, f"no such folder, but it is in {PATH_VARIABLE}")
    return [root.resolve() for root in named]


def activate(start: Path | None = None) -> tuple[Path, ...]:
    """Make the workspace's modules and interfaces importable in this process.

    Return the folders that were appended to ``sys.path``.
    """
    added = []
    for package in _first_of_each(_not_built_in(start)):
        if package.has_interfaces:
            _add_interfaces(package)
        folder = package.python_path
        if folder is not None and str(folder) not in sys.path:
            sys.path.append(str(folder))
            added.append(folder)
    return tuple(added)


def _add_interfaces(package: Package) -> None:
    if (DEFINITIONS / package.name).is_dir():
        if package.origin is Origin.SOURCE:
            prefer_interfaces(package.name, package.folder)
    elif package.name in msgs.packages():
        return
    elif package.folder.name == package.name:
        # Read on first use: the types may use those of packages that are added later.
        msgs.add_interface_path(package.folder.parent)
    else:
        msgs.load_interfaces(package.name, package.folder)


def _first_of_each(packages: Iterable[Package]) -> list[Package]:
    """Return the first package of each name, sorted by name."""
    found: dict[str, Package] = {}
    for package in packages:
        found.setdefault(package.name, package)
    return [found[name] for name in sorted(found)]


def _all(start: Path | None) -> Iterator[Package]:
    """Yield all packages in order of precedence; a name may occur several times."""
    yield from _not_built_in(start)
    yield from _built_in()


def _not_built_in(start: Path | None) -> Iterator[Package]:
    here, depth = _workspace_root((start or Path.cwd()).resolve())
    if here in _named_roots():  # explicitly a workspace
        depth = _DEPTH
    for root in search_roots(start):
        yield from _crawl(root, depth if root == here else _DEPTH)
    for prefix in installed_prefixes():
        yield from _installed(prefix)


def _workspace_root(start: Path) -> tuple[Path, int]:
    """Return the folder below which packages are searched, and the depth."""
    for folder in (start, *start.parents):
        if (folder / FILE_NAME).is_file():
            above = folder.parents[:_SRC_ABOVE]
            source = next((each for each in above if each.name == "src"), None)
            return (source, _DEPTH) if source else (folder.parent, _DEPTH_BESIDE)
    for folder in (start, *start.parents):
        if folder.name == "src":
            return folder, _DEPTH
    if (start / "src").is_dir():
        return start / "src", _DEPTH
    return start, _DEPTH_BESIDE


def _crawl(root: Path, depth: int) -> Iterator[Package]:
    seen: dict[str, Path] = {}
    for folder in _package_folders(root, depth):
        name = read_manifest(folder / FILE_NAME).name
        if name in seen:
            raise InvalidNameError(
                f"two packages are named {name!r}: {seen[name]} and {folder}; "
                f"a file {_IGNORE_FILES[0]} in one of them hides it"
            )
        seen[name] = folder
        yield Package(name, folder, Origin.SOURCE)


def _package_folders(folder: Path, depth: int) -> Iterator[Path]:
    """Yield folders with a package.xml, sorted; packages are not nested."""
    # One scandir per folder, because every start of a program does this search.
    try:
        with os.scandir(folder) as listed:
            entries = {entry.name: entry for entry in listed}
    except PermissionError:
        return  # not readable: not a package of this user
    if not entries.keys().isdisjoint(_IGNORE_FILES):
        return
    if FILE_NAME in entries and entries[FILE_NAME].is_file():
        yield folder
    elif depth > 0:
        for name in sorted(filter(_may_hold_packages, entries)):
            if entries[name].is_dir():
                yield from _package_folders(folder / name, depth - 1)


def _may_hold_packages(name: str) -> bool:
    return not name.startswith(".") and name not in _OUTPUT_FOLDERS


def installed_prefixes() -> tuple[Path, ...]:
    """Return the existing prefixes of installed packages in order of precedence."""
    named = [Path(each) for each in _variable(AMENT_VARIABLE)]
    return tuple(prefix for prefix in (*named, Path(sys.prefix)) if prefix.is_dir())


def _installed(prefix: Path) -> Iterator[Package]:
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    if index.is_dir():
        for marker in sorted(index.iterdir()):
            if marker.is_file() and is_package_name(marker.name):
                share = prefix / "share" / marker.name
                yield Package(marker.name, share, Origin.INSTALLED)


def _built_in() -> Iterator[Package]:
    """Yield the packages with Navette's programs or definitions of interfaces."""
    folders = [folder for folder in sorted(DEFINITIONS.iterdir()) if folder.is_dir()]
    for name in sorted(PACKAGES_OF_PROGRAMS - {folder.name for folder in folders}):
        yield Package(name, Path(__file__).parents[2], Origin.BUILT_IN)
    for folder in folders:
        yield Package(folder.name, folder, Origin.BUILT_IN)


def _variable(name: str) -> list[str]:
    return [each for each in os.environ.get(name, "").split(os.pathsep) if each]
