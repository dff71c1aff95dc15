"""Token bucket: a rate limit that permits bursts."""

from navette.viewer.wall_clock import WallClock


class TokenBucket:
    """Tokens that refill at a constant rate up to a maximum.

    Taking more than there is leaves a debt: :meth:`wait_s` returns the time until the
    debt is paid off.

    Args:
        rate_per_s: tokens that are added per second.
        burst: maximum number of tokens, and their number at the start.
    """

    def __init__(self, rate_per_s: float, burst: float, clock: WallClock) -> None:
        self._rate_per_s, self._burst, self._clock = rate_per_s, burst, clock
        self._tokens = burst
        self._refilled_s = clock.now_s

    def take(self, count: float) -> None:
        """Take tokens, also more than there are."""
        self._refill()
        self._tokens -= count

    def try_take(self, count: float) -> bool:
        """Take tokens if they are there; return whether they were."""
        self._refill()
        if self._tokens < count:
            return False
        self._tokens -= count
        return True

    def wait_s(self) -> float:
        """Return the time until nothing is owed; 0 if nothing is."""
        self._refill()
        return max(0.0, -self._tokens / self._rate_per_s)

    @property
    def is_full(self) -> bool:
        self._refill()
        return self._tokens >= self._burst

    def _refill(self) -> None:
        now_s = self._clock.now_s
        added = (now_s - self._refilled_s) * self._rate_per_s
        self._tokens = min(self._burst, self._tokens + added)
        self._refilled_s = now_s
