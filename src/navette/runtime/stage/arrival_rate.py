"""The measured rate of an input, and how late its next message may be."""

import math
from collections import deque
from statistics import median

_INTERVALS = 9
_FEWEST_INTERVALS = 3
# A message may be as late as this many periods: one may be lost, and the
# robot still stops within half a second.
_PERIODS_ALLOWED = 2.45


class ArrivalRate:
    """Median interval between the newest arrivals.

    The median is the true period while fewer than half of the messages are lost.
    """

    def __init__(self) -> None:
        self._last_ns: int | None = None
        self._intervals_ns: deque[int] = deque(maxlen=_INTERVALS)

    def note(self, now_ns: int) -> None:
        """Note an arrival; a clock that was set back starts the measurement again."""
        if self._last_ns is not None:
            if now_ns < self._last_ns:
                self._intervals_ns.clear()
            elif now_ns > self._last_ns:
                self._intervals_ns.append(now_ns - self._last_ns)
        self._last_ns = now_ns

    @property
    def allowed_age_s(self) -> float:
        """Age at which the newest message is stale; infinite before it is measured."""
        if len(self._intervals_ns) < _FEWEST_INTERVALS:
            return math.inf
        return _PERIODS_ALLOWED * median(self._intervals_ns) / 1e9
