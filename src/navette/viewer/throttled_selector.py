"""Limit on the CPU time of an asyncio loop's thread.

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


class ThrottledSelector(selectors.DefaultSelector):
    """Selector that sleeps while its thread has used more CPU time than its share.

    Args:
        share: seconds of CPU time per second.
        burst_s: CPU time that may be used at once.
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
        self._cpu_s, self._sleep = cpu_s, sleep or threading.Event().wait
        self._used_s: float | None = None

    def select(self, timeout: float | None = None) -> Any:
        used_s = self._cpu_s()
        # The first call is in the loop's thread; the constructor may not be.
        if self._used_s is not None:
            self._bucket.take(used_s - self._used_s)
        self._used_s = used_s
        if wait_s := self._bucket.wait_s():
            self._sleep(wait_s)
            timeout = 0.0
        return super().select(timeout)
