"""Measured period of an input, and the timeout that follows from it."""

from collections import deque
from statistics import median

# Arrivals from which the period is measured; the median ignores lost messages.
_INTERVALS = 11
_FEWEST = 3
# No sensor is so slow that the robot drives longer than this without its data, unless
# the parameter is larger.
_LONGEST_S = 0.42


class InputPeriod:
    """Median time between the newest arrivals of an input."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget all arrivals."""
        self._last_ns: int | None = None
        self._intervals: deque[int] = deque(maxlen=_INTERVALS)
        self._period_s: float | None = 0.0  # None: not computed yet

    def note(self, now_ns: int) -> None:
        """Add an arrival."""
        if self._last_ns is not None and now_ns > self._last_ns:
            self._intervals.append(now_ns - self._last_ns)
            if len(self._intervals) >= _FEWEST:
                self._period_s = None
        self._last_ns = now_ns

    @property
    def seconds(self) -> float:
        """The period; 0 until it has been measured."""
        if self._period_s is None:
            self._period_s = median(self._intervals) / 1e9
        return self._period_s

    def timeout_s(self, least_s: float, periods: float) -> float:
        """Return the age at which the input is stale.

        Args:
            least_s: for fast inputs.
            periods: for slower ones, up to 0.42 s.
        """
        return max(least_s, min(periods * self.seconds, _LONGEST_S))
