"""Matchers that select the nodes of an event."""

from collections.abc import Callable
from typing import Any


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a matcher of the node with this full name; the first ``/`` is optional."""
    full_name = f"/{node_name.lstrip('/')}"
    return lambda action: bool(action.node_name == full_name)
