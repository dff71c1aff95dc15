"""Which nodes an event is for."""

from collections.abc import Callable
from typing import Any


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Picks the node action of this full name (``/`` in front may be left out)."""
    wanted = f"/{node_name.lstrip('/')}"
    return lambda action: bool(action.node_name == wanted)
