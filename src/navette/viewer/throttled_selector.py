"""Limit on the time of an asyncio loop's thread.

Python runs one thread at a time: work of the socket thread delays the robot's nodes in
the same process. Bounds on frames keep each piece of work short; this limit bounds
their sum, whatever the work is (handshakes, pings, parsing, encryption).
"""

import selectors
from typing import Any

from navette.viewer.token_bucket import TokenBucket
from navette.viewer.wall_clock import WallClock
from navette.viewer.work_time import WorkTime


class ThrottledSelector(selectors.DefaultSelector):
    """Selector that sleeps while its thread has worked more than its share.

    Work (:class:`~navette.viewer.work_time.WorkTime`) is what the thread does outside
    :meth:`select`.

    Args:
        share: seconds of work per second.
        burst_s: work that may be done at once.
    """

    def __init__(self, share: float, burst_s: float, clock: WallClock) -> None:
        super().__init__()
        self._bucket = TokenBucket(share, burst_s, clock)
        self._work = WorkTime(clock)  # begun in the thread whose time counts
        self._clock = clock

    def select(self, timeout: float | None = None) -> Any:
        self._bucket.take(self._work.elapsed_s())
        wait_s = self._bucket.wait_s()
        if wait_s:
            self._clock.sleep(wait_s)
            timeout = 0.0
        events = super().select(timeout)
        self._work.begin()
        return events
