"""Which interfaces there are, by kind and package."""

from collections.abc import Iterable
from enum import Enum

from navette.cli.nearest import did_you_mean
from navette.cli.session import fail
from navette.errors import UnknownNameError
from navette.ros2.packages.rosidl_runtime_py.get_interfaces import (
    get_interface_packages,
    get_interfaces,
)


class Kind(Enum):
    """What an interface is; the value is the folder of its files."""

    MESSAGE = "msg"
    SERVICE = "srv"
    ACTION = "action"

    @property
    def title(self) -> str:
        return f"{self.name.capitalize()}s"


def chosen_kinds(msgs: bool, srvs: bool, actions: bool) -> list[Kind]:
    """Those asked for; all if none is."""
    chosen = [
        kind
        for kind, is_asked in zip(Kind, (msgs, srvs, actions), strict=True)
        if is_asked
    ]
    return chosen or list(Kind)


def interfaces(kind: Kind) -> list[str]:
    """Full names of all of a kind, sorted."""
    return sorted(
        f"{package}/{name}"
        for package, names in get_interfaces().items()
        for name in names
        if name.startswith(f"{kind.value}/")
    )


def interfaces_of(package: str, kinds: Iterable[Kind]) -> list[str]:
    """Full names of a package's; ends the command if there is no such package."""
    try:
        found = get_interfaces([package]).get(package, [])
    except UnknownNameError:
        fail(f"no package {package}{did_you_mean(package, get_interface_packages())}")
    chosen = tuple(f"{kind.value}/" for kind in kinds)
    return [f"{package}/{name}" for name in found if name.startswith(chosen)]


def packages(kinds: Iterable[Kind]) -> list[str]:
    """Packages that have interfaces of those kinds, sorted."""
    chosen = tuple(f"{kind.value}/" for kind in kinds)
    return sorted(
        package
        for package, names in get_interfaces().items()
        if any(name.startswith(chosen) for name in names)
    )
