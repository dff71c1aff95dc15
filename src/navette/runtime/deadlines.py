"""Watchdog timer for QoS deadlines and liveliness leases."""

import threading
from collections.abc import Callable

from navette.runtime.events import Call
from navette.runtime.loop import EventLoop

OnExpiry = Callable[[], None]
"""Called in the loop's thread when a period is over."""


class Watchdog:
    """Reports when :meth:`restart` has not been called for ``period_ns``.

    The first restart starts the watchdog; after it expired, it expires again every
    period. :meth:`restart` and :meth:`stop` are callable from any thread.
    """

    __slots__ = (
        "_call",
        "_due_ns",
        "_lock",
        "_loop",
        "_node",
        "_on_expiry",
        "_period_ns",
    )

    def __init__(
        self,
        period_ns: int,
        loop: EventLoop,
        node: str,
        *,
        on_expiry: OnExpiry,
    ) -> None:
        self._period_ns = period_ns
        self._on_expiry = on_expiry
        self._loop = loop
        self._node = node
        self._due_ns = 0
        self._call: Call | None = None
        self._lock = threading.Lock()

    def restart(self) -> None:
        """Count from now. Cheap: the pending call reschedules itself when it runs."""
        self._due_ns = self._loop.clock.now_ns + self._period_ns
        if self._call is None:
            with self._lock:
                if self._call is None:
                    self._arm()

    def stop(self) -> None:
        """Stop until the next :meth:`restart`."""
        with self._lock:
            if self._call is not None:
                self._call.cancel()
                self._call = None

    def _arm(self) -> None:
        self._call = self._loop.call_at(
            self._due_ns, self._check, "deadline", self._node
        )

    def _check(self) -> None:
        with self._lock:
            if self._call is None:
                return
            is_over = self._loop.clock.now_ns >= self._due_ns
            if is_over:
                self._due_ns += self._period_ns
            self._arm()
        if is_over:
            self._on_expiry()
