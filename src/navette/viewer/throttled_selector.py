"""Limit on the time of an asyncio loop's thread.

Python runs one thread at a time: work of the socket thread delays the robot's nodes in
the same process. Bounds on frames keep each piece of work short; this limit bounds
their sum, whatever the work is (handshakes, pings, parsing, encryption).
"""

import selectors
import threading
import time
from collections.abc import Callable
from typing import Any

from navette.viewer.token_bucket import TokenBucket

_CPU_WEIGHT = 3.0  # the most that a second of CPU time counts


class ThrottledSelector(selectors.DefaultSelector):
    """Selector that sleeps while its thread has worked more than its share.

    Work is CPU time of the thread outside :meth:`select`. On a machine that is short of
    CPU time it counts up to three times, as the thread takes more of what the process
    receives; but not the whole wall time: a thread that waits for the interpreter
    delays no node, and an operator's command must not wait for a debt of others.

    Args:
        share: seconds of work per second.
        burst_s: work that may be done at once.
        now_s: monotonic wall time.
        cpu_s: CPU time of the calling thread.
    """

    def __init__(
        self,
        share: float,
        burst_s: float,
        now_s: Callable[[], float],
        *,
        cpu_s: Callable[[], float] = time.thread_time,
        sleep: Callable[[float], object] | None = None,
    ) -> None:
        super().__init__()
        self._bucket = TokenBucket(share, burst_s, now_s)
        self._now_s, self._cpu_s = now_s, cpu_s
        self._sleep = sleep or threading.Event().wait
        # Wall and CPU time; set in the thread whose time counts.
        self._selected_s: tuple[float, float] | None = None

    def select(self, timeout: float | None = None) -> Any:
        if self._selected_s is not None:
            wall_s = self._now_s() - self._selected_s[0]
            cpu_s = self._cpu_s() - self._selected_s[1]
            self._bucket.take(min(wall_s, _CPU_WEIGHT * cpu_s))
        wait_s = self._bucket.wait_s()
        if wait_s:
            self._sleep(wait_s)
            timeout = 0.0
        events = super().select(timeout)
        self._selected_s = self._now_s(), self._cpu_s()
        return events
