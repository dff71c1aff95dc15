"""List interfaces by kind and package."""

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
    """Kind of an interface; the value is the folder of its files."""

    MESSAGE = "msg"
    SERVICE = "srv"
    ACTION = "action"

    @property
    def title(self) -> str:
        return f"{self.name.capitalize()}s"


def chosen_kinds(msgs: bool, srvs: bool, actions: bool) -> list[Kind]:
    """Return the selected kinds; all if none is selected."""
    chosen = [
        kind
        for kind, is_selected in zip(Kind, (msgs, srvs, actions), strict=True)
        if is_selected
    ]
    return chosen or list(Kind)


def interfaces(kind: Kind) -> list[str]:
    """Return the sorted full names of all interfaces of a kind."""
    return sorted(
        f"{package}/{name}"
        for package, names in get_interfaces().items()
        for name in names
        if name.startswith(f"{kind.value}/")
    )


def interfaces_of(package: str, kinds: Iterable[Kind]) -> list[str]:
    """Return the full names of a package's interfaces; fail if it is unknown."""
    try:
        found = get_interfaces([package]).get(package, [])
    except UnknownNameError:
        fail(f"no package {package}{did_you_mean(package, get_interface_packages())}")
    chosen = tuple(f"{kind.value}/" for kind in kinds)
    return [f"{package}/{name}" for name in found if name.startswith(chosen)]


def packages(kinds: Iterable[Kind]) -> list[str]:
    """Return the sorted names of packages with interfaces of these kinds."""
    chosen = tuple(f"{kind.value}/" for kind in kinds)
    return sorted(
        package
        for package, names in get_interfaces().items()
        if any(name.startswith(chosen) for name in names)
    )
