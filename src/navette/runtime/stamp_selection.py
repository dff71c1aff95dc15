"""Selection of messages by their stamps, for inputs faster than required."""

import math


class StampSelection:
    """Selects the last message of each period: the newest one at the end of the period.

    Periods begin at multiples of their length. The next stamp is predicted from the
    interval between the last two.

    Args:
        rate_hz: periods per second; infinite or 0: every message is selected.
    """

    def __init__(self, rate_hz: float = math.inf) -> None:
        self._last_ns: int | None = None
        self.rate_hz = rate_hz

    @property
    def rate_hz(self) -> float:
        return self._rate_hz

    @rate_hz.setter
    def rate_hz(self, rate_hz: float) -> None:
        self._rate_hz = rate_hz
        self._period_ns = round(min(1e9 / rate_hz, 1e18)) if rate_hz > 0 else 0

    def takes(self, stamp_ns: int) -> bool:
        """Return whether to use the message with this stamp; called for each."""
        last_ns, self._last_ns = self._last_ns, stamp_ns
        if not self._period_ns or last_ns is None or stamp_ns <= last_ns:
            return True
        next_ns = 2 * stamp_ns - last_ns
        return next_ns // self._period_ns > stamp_ns // self._period_ns
