"""Ratio of measured to commanded turn rate, estimated while driving."""

import math

_LAG_S = 0.15  # first-order lag of the drive, applied to the command
_MEMORY_S = 3.0
_PRIOR = 0.1  # rad²/s, weight of the initial estimate 1
_LOWEST, _HIGHEST = 0.7, 1.2


class TurnGain:
    """Least-squares ratio of measured to commanded turn rate, with forgetting.

    Wide wheels scrub: a real or simulated differential drive turns 10–25 % slower
    than commanded. Pure pursuit alone then deviates by κ L²/8 in every bend.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._expected = 0.0
        self._product = _PRIOR
        self._square = _PRIOR

    @property
    def value(self) -> float:
        """Measured over commanded turn rate; 1 before the first update."""
        return min(_HIGHEST, max(_LOWEST, self._product / self._square))

    def update(self, commanded: float, measured: float, dt: float) -> None:
        """Add the last commanded and the measured turn rate (rad/s) of one step."""
        self._expected += (commanded - self._expected) * min(1.0, dt / _LAG_S)
        if abs(self._expected) < 0.1:
            return  # too slow to measure the ratio; keep the estimate
        keep = math.exp(-dt / _MEMORY_S)
        prior = (1 - keep) * _PRIOR
        self._product = keep * self._product + prior + self._expected * measured * dt
        self._square = keep * self._square + prior + self._expected**2 * dt
