"""Filter of the output of processes."""

from collections.abc import Callable, Iterable
from typing import Any

from navette.ros2.packages.launch_testing.tools import (
    basic_output_filter as _basic_output_filter,
)

__all__ = ["basic_output_filter"]


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[Any] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[str], str]:
    """Return a function that removes lines by their start or by a pattern.

    Args:
        filtered_prefixes: default: ``pid`` and ``rc``.
        filtered_rmw_implementation: accepted without effect: no middleware prints here.
    """
    return _basic_output_filter(filtered_prefixes, filtered_patterns)
