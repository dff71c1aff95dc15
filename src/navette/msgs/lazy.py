"""Contents of the modules ``navette.msgs.<package>.<kind>``, made on first use."""

from collections.abc import Callable
from typing import Any

from navette.msgs.registry import interface_names


def module_contents(
    namespace: dict[str, Any],
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return ``__getattr__``, ``__dir__`` and ``__all__`` of a module.

    ``namespace`` are its globals. Classes are stored there, so that ``__getattr__`` is
    called once for each.
    """
    module = namespace["__name__"]
    package, kind = module.split(".")[-2:]
    names = interface_names(package, kind)

    def get(name: str) -> Any:
        # The parts of services and actions are module members, too, as in ROS 2.
        if name.partition("_")[0] not in names:
            raise AttributeError(
                f"module {module!r} has no {name!r}; it has {', '.join(names)}"
            )
        from navette.msgs.classes import get_interface

        namespace[name] = get_interface(f"{package}/{kind}/{name}")
        return namespace[name]

    def listed() -> list[str]:
        return names

    return get, listed, names
