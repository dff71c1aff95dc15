"""Choice of the stages' methods and of the localization, by option or argument."""

from collections.abc import Mapping

from navette.errors import UnknownNameError

METHOD_PARAMETERS = {
    "planner": ("planner", "method"),
    "controller": ("control", "method"),
    "costmap": ("costmap", "method"),
    "mapping": ("map_memory", "fusion"),
    "localization": ("sim", "localization"),
}
"""What is chosen → node and its parameter."""


def method_parameters(chosen: Mapping[str, str]) -> dict[str, dict[str, str]]:
    """Return node → parameter → value.

    Raises:
        UnknownNameError: nothing of this name can be chosen; lists what can.
    """
    found: dict[str, dict[str, str]] = {}
    for kind, name in chosen.items():
        if kind not in METHOD_PARAMETERS:
            raise UnknownNameError.of("kind of method", kind, [*METHOD_PARAMETERS])
        node, parameter = METHOD_PARAMETERS[kind]
        found.setdefault(node, {})[parameter] = name
    return found
