"""ament_index_python.resources: marker files of the ament index, by type and name.

The types ``packages`` and ``rosidl_interfaces`` include packages that are not
installed.
"""

from collections.abc import Iterator
from pathlib import Path

from navette.errors import InvalidNameError, UnknownNameError
from navette.ros2.packages.ament_index_python.constants import RESOURCE_INDEX_SUBFOLDER
from navette.ros2.workspace import Package, find_packages
from navette.ros2.workspace.finding import installed_prefixes
from navette.ros2.workspace.package import INTERFACE_KINDS

_PACKAGES = "packages"
_INTERFACES = "rosidl_interfaces"


class InvalidResourceTypeNameError(InvalidNameError):
    """The resource type is empty or contains a slash."""


class InvalidResourceNameError(InvalidNameError):
    """The resource name is empty or contains a slash."""


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the content of a resource and its prefix.

    Raises:
        LookupError: the resource does not exist; lists the existing ones.
        InvalidResourceTypeNameError, InvalidResourceNameError
    """
    _check_names(resource_type, resource_name)
    for name, prefix, file in _resources(resource_type):
        if name == resource_name:
            return file.read_text(encoding="utf-8"), prefix
    for package in _packages_with(resource_type):
        if package.name == resource_name:
            return _content(package, resource_type), str(package.prefix)
    known = list(get_resources(resource_type))
    raise UnknownNameError.of(
        f"resource of type {resource_type!r}", resource_name, known
    )


def get_resources(resource_type: str) -> dict[str, str]:
    """Return the prefixes of all resources of a type by name."""
    _check_names(resource_type, "any")
    found: dict[str, str] = {}
    for package in _packages_with(resource_type):
        found[package.name] = str(package.prefix)
    for name, prefix, _ in _resources(resource_type):
        found.setdefault(name, prefix)
    return found


def get_resource_types() -> set[str]:
    indices = (prefix / RESOURCE_INDEX_SUBFOLDER for prefix in installed_prefixes())
    names = {f.name for index in indices if index.is_dir() for f in index.iterdir()}
    return {_PACKAGES, _INTERFACES, *(n for n in names if not n.startswith("."))}


def has_resource(resource_type: str, resource_name: str) -> str | bool:
    """Return the prefix of a resource, False if it does not exist."""
    _check_names(resource_type, resource_name)
    return get_resources(resource_type).get(resource_name, False)


def _check_names(resource_type: str, resource_name: str) -> None:
    if not resource_type or set(resource_type) & set("/\\"):
        raise InvalidResourceTypeNameError(
            f"resource type {resource_type!r}: must not be empty or contain a slash"
        )
    if not resource_name or set(resource_name) & set("/\\"):
        raise InvalidResourceNameError(
            f"resource name {resource_name!r}: must not be empty or contain a slash"
        )


def _resources(resource_type: str) -> Iterator[tuple[str, str, Path]]:
    """Yield name, prefix and file of the installed markers."""
    for prefix in installed_prefixes():
        folder = prefix / RESOURCE_INDEX_SUBFOLDER / resource_type
        if folder.is_dir():
            for file in sorted(folder.iterdir()):
                if file.is_file() and not file.name.startswith("."):
                    yield file.name, str(prefix), file


def _packages_with(resource_type: str) -> list[Package]:
    if resource_type not in (_PACKAGES, _INTERFACES):
        return []
    return [
        package
        for package in find_packages().values()
        if resource_type == _PACKAGES or package.has_interfaces
    ]


def _content(package: Package, resource_type: str) -> str:
    if resource_type == _PACKAGES:
        return ""
    files = (
        f"{kind}/{file.name}"
        for kind in INTERFACE_KINDS
        for file in sorted((package.share / kind).glob(f"*.{kind}"))
    )
    return "\n".join(files)
