"""Limit on the time of an asyncio loop's thread.

Python runs one thread at a time: work of the socket thread delays the robot's nodes in
the same process. Bounds on frames keep each piece of work short; this limit bounds
their sum, whatever the work is (handshakes, pings, parsing, encryption).
"""

import selectors
import threading
from collections.abc import Callable
from typing import Any

from navette.viewer.token_bucket import TokenBucket


class ThrottledSelector(selectors.DefaultSelector):
    """Selector that sleeps while its thread has worked more than its share.

    Work is wall time outside :meth:`select`, not CPU time: on a machine that is short
    of CPU time, the thread leaves most of what the process receives to other threads.

    Args:
        share: seconds of work per second.
        burst_s: work that may be done at once.
        now_s: monotonic wall time.
    """

    def __init__(
        self,
        share: float,
        burst_s: float,
        now_s: Callable[[], float],
        *,
        sleep: Callable[[float], object] | None = None,
    ) -> None:
        super().__init__()
        self._bucket = TokenBucket(share, burst_s, now_s)
        self._now_s = now_s
        self._sleep = sleep or threading.Event().wait
        self._selected_s = now_s()

    def select(self, timeout: float | None = None) -> Any:
        self._bucket.take(self._now_s() - self._selected_s)
        wait_s = self._bucket.wait_s()
        if wait_s:
            self._sleep(wait_s)
            timeout = 0.0
        events = super().select(timeout)
        self._selected_s = self._now_s()
        return events
