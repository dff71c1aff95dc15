"""How much of the commanded turn rate the wheels deliver, learned on the way."""

import math

_LAG_S = 0.15  # first-order answer of the drive, for comparing like with like
_MEMORY_S = 3.0
_PRIOR = 0.1  # rad²/s: turning seen before the estimate leaves 1
_LOWEST, _HIGHEST = 0.7, 1.2


class TurnGain:
    """Least-squares ratio of measured to commanded turn rate, with forgetting.

    Wide wheels scrub: a real or simulated differential drive turns 10–25 % slower
    than told. Pure pursuit alone then runs wide by κ L²/8 in every bend.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._expected = 0.0
        self._product = _PRIOR
        self._square = _PRIOR

    @property
    def value(self) -> float:
        """Measured over commanded turn rate, 1 before anything was learned."""
        return min(_HIGHEST, max(_LOWEST, self._product / self._square))

    def update(self, commanded: float, measured: float, dt: float) -> None:
        """One tick: the last command and the turn rate (rad/s) measured now."""
        self._expected += (commanded - self._expected) * min(1.0, dt / _LAG_S)
        if abs(self._expected) < 0.1:
            return  # says nothing about the ratio; do not forget either
        keep = math.exp(-dt / _MEMORY_S)
        prior = (1 - keep) * _PRIOR
        self._product = keep * self._product + prior + self._expected * measured * dt
        self._square = keep * self._square + prior + self._expected**2 * dt
