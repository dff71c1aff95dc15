"""Message, service and action classes by name, for fields that vary with the kind."""

from typing import Any

from navette.msgs import get_interface


def interface(name: str) -> Any:
    """Return the class of an interface such as ``nav2_msgs/action/Spin``."""
    return get_interface(name)


def action_interface(name: str) -> Any:
    return get_interface(f"nav2_msgs/action/{name}")
