"""Time as the transports and other low layers receive it."""

from typing import Protocol


class NanosecondClock(Protocol):
    """The clock of a program: simulated or system time."""

    @property
    def now_ns(self) -> int:
        """Nanoseconds since the clock's epoch; callable from any thread."""
