"""Time as the parts of the live view receive it; tests pass a clock of their own."""

from typing import Protocol


class WallClock(Protocol):
    """Steady time of the machine and CPU time of the calling thread.

    The live view limits rates, shares and delays in wall time, whatever clock the
    program uses.
    """

    @property
    def now_s(self) -> float:
        """Seconds since any start; never steps back."""

    @property
    def thread_cpu_s(self) -> float:
        """CPU time of the calling thread in seconds."""

    def sleep(self, duration_s: float) -> None:
        """Block the calling thread."""
