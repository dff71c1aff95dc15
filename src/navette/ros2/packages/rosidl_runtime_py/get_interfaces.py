"""rosidl_runtime_py.get_interfaces: lists of interfaces, and their files."""

from collections.abc import Iterable
from pathlib import Path

from navette import msgs
from navette.errors import InvalidNameError, UnknownNameError
from navette.msgs.registry import definition_file
from navette.ros2.workspace import find_package, find_packages
from navette.ros2.workspace.package import INTERFACE_KINDS, Origin

_PROVIDED = Path(__file__).parent.parent


def get_interface_packages() -> dict[str, str]:
    """Return the prefixes of the packages that define interfaces, by name."""
    packages = find_packages().values()
    return {p.name: str(p.prefix) for p in packages if p.has_interfaces}


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the interfaces (``msg/String``) of packages; default: all packages.

    Packages without interfaces are omitted.

    Raises:
        LookupError: a package does not exist.
    """
    return _interfaces(package_names, INTERFACE_KINDS)


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    return _interfaces(package_names, ("msg",))


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    return _interfaces(package_names, ("srv",))


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    return _interfaces(package_names, ("action",))


def get_interface_path(interface_name: str) -> str:
    """Return the file that defines ``pkg/msg/Name`` (with or without ``.msg``).

    Raises:
        ValueError: the name has the wrong form.
        LookupError: the package or interface does not exist; lists the existing ones.
    """
    parts = interface_name.split("/")
    if len(parts) < 2 or not all(parts) or ".." in parts:
        raise InvalidNameError(
            f"interface name {interface_name!r}: expected 'package/msg/Name'"
        )
    package = find_package(parts[0])
    path = Path(package.share, *parts[1:])
    if not path.suffix:
        path = path.with_name(f"{path.name}.{parts[-2]}")
    if package.origin is Origin.BUILT_IN and len(parts) == 3:
        # Folders of NAVETTE_INTERFACE_PATH and of the distribution come first.
        path = definition_file("/".join((*parts[:2], path.stem))) or path
    if not path.is_file():
        known = get_interfaces([parts[0]]).get(parts[0], [])
        raise UnknownNameError.of(f"interface of {parts[0]}", interface_name, known)
    return str(path)


def _interfaces(names: Iterable[str], kinds: Iterable[str]) -> dict[str, list[str]]:
    kinds = tuple(kinds)
    loaded = set(msgs.packages())
    packages = list(names) or sorted({*get_interface_packages(), *loaded})
    found: dict[str, list[str]] = {}
    for name in packages:
        # A program can load interfaces that do not belong to any package.
        listed = _loaded(name, kinds) if name in loaded else _in_files(name, kinds)
        if listed:
            found[name] = listed
    return found


def _loaded(package: str, kinds: tuple[str, ...]) -> list[str]:
    return [
        f"{kind}/{name}"
        for kind in kinds
        for name in msgs.interface_names(package, kind)
    ]


def _in_files(package: str, kinds: tuple[str, ...]) -> list[str]:
    if (_PROVIDED / package).is_dir():
        return []
    share = find_package(package).share
    return [
        f"{kind}/{file.stem}"
        for kind in kinds
        for file in sorted((share / kind).glob(f"*.{kind}"))
    ]
