"""Markers of test descriptions and tests."""

from collections.abc import Callable
from functools import wraps
from threading import Event
from typing import Any


def keep_alive(test_description: Any) -> Any:
    """Keep the launch running while the tests run, also without any process."""
    _markers(test_description)["keep_alive"] = True
    return test_description


def retry_on_failure(*, times: int, delay: float | None = None) -> Callable[[Any], Any]:
    """Run a test method again after a failed assertion.

    Args:
        times: maximum number of runs.
        delay: seconds between runs.
    """

    def mark(function: Any) -> Any:
        @wraps(function)
        def call(self: Any, *args: Any, **kwargs: Any) -> Any:
            for left in reversed(range(times)):
                try:
                    return function(self, *args, **kwargs)
                except AssertionError:
                    if not left:
                        raise
                    if delay:
                        Event().wait(delay)
            return None

        return call

    return mark


def _markers(function: Any) -> dict[str, Any]:
    if not hasattr(function, "__markers__"):
        function.__markers__ = {}
    found: dict[str, Any] = function.__markers__
    return found
