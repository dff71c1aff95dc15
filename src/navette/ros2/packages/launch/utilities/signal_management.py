"""Signals whose handlers run in an asyncio loop."""

import asyncio
import signal
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any

Handler = Callable[[int], Any]


class AsyncSafeSignalManager:
    """Context in which handlers of signals run between the callbacks of a loop.

    Args:
        loop: runs the handlers; the context must be entered in the main thread.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._handlers: dict[int, Handler] = {}
        self._before: dict[int, Any] | None = None

    def handle(self, signum: int, handler: Handler | None) -> Handler | None:
        """Set the handler of a signal, or remove it (None); return the one before."""
        before = self._handlers.pop(signum, None)
        if handler is not None:
            self._handlers[signum] = handler
        if self._before is not None:
            self._install(signum)
        return before

    def _install(self, signum: int) -> None:
        assert self._before is not None, "within the context"
        if signum in self._handlers:
            before = signal.signal(signum, self._on_signal)
            self._before.setdefault(signum, before)
        elif signum in self._before:
            signal.signal(signum, self._before.pop(signum))

    def _on_signal(self, signum: int, frame: FrameType | None) -> None:
        handler = self._handlers.get(signum)
        if handler is not None:
            number = signal.Signals(signum)
            self._loop.call_soon_threadsafe(handler, number)

    def __enter__(self) -> "AsyncSafeSignalManager":
        self._before = {}
        for signum in self._handlers:
            self._install(signum)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        before, self._before = self._before or {}, None
        for signum, handler in before.items():
            signal.signal(signum, handler)
