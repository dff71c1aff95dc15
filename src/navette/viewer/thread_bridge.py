"""Interface between the two threads of the live view."""

from collections.abc import Callable
from typing import Any, Protocol


class ThreadBridge(Protocol):
    """Runs functions on the socket thread or the executor's.

    All methods return at once and are called on any thread.
    """

    def call_hub(self, method: Callable[..., None], *args: Any) -> None:
        """Run a method of the hub on the socket thread and send what it queued."""

    def call_later(self, delay_s: float, function: Callable[[], None]) -> None:
        """Run ``function`` on the socket thread after a delay."""

    def run_soon(self, function: Callable[[], object], source: str) -> None:
        """Run ``function`` on the executor's thread; ``source`` names it in errors."""
