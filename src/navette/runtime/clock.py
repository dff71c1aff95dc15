"""Clocks of a context: virtual, paced or system time.

The loop advances its clock to the time of the next event. A virtual clock
jumps there, a paced clock waits first, and with the system clock the loop waits. Other
modules of the runtime do not read the wall clock.
"""

import threading
import time
from abc import ABC, abstractmethod

from navette.errors import InvalidValueError
from navette.runtime.wakeup import Wakeup

# A paced clock that lags by more than this does not catch up.
_MAX_CATCH_UP_S = 0.25


class ContextClock(ABC):
    """Time of a context, in integer nanoseconds."""

    #: Whether time advances by events only, not by waiting.
    is_virtual: bool = False
    #: Whether virtual time follows the wall clock.
    is_paced: bool = False
    #: Whether time jumps to the next event: computations take no time.
    jumps: bool = False
    #: Whether other processes share the clock, so that a run without events waits for
    #: theirs instead of ending.
    is_shared: bool = False

    @property
    @abstractmethod
    def now_ns(self) -> int:
        """Nanoseconds since the clock's epoch."""

    @abstractmethod
    def go_to(self, target_ns: int | None, wakeup: Wakeup) -> bool:
        """Wait until ``target_ns`` (None: no limit); False if woken before."""


class SystemClock(ContextClock):
    """The system clock: nanoseconds since 1970."""

    @property
    def now_ns(self) -> int:
        return time.time_ns()

    def go_to(self, target_ns: int | None, wakeup: Wakeup) -> bool:
        if target_ns is None:
            return not wakeup.wait(None)
        left_ns = target_ns - time.time_ns()
        return left_ns <= 0 or not wakeup.wait(left_ns / 1e9)


class VirtualClock(ContextClock):
    """Simulated time that jumps to the next event."""

    is_virtual = True
    jumps = True
    now_ns: int = 0

    def __init__(self, start_ns: int = 0) -> None:
        if start_ns < 0:
            raise InvalidValueError(f"start time must be >= 0 ns, got {start_ns} ns")
        self.now_ns = start_ns
        self._limit_ns: int | None = None  # to which time advances while paused

    @property
    def paused(self) -> bool:
        """Whether virtual time is stopped; calls of other threads still run."""
        return self._limit_ns is not None

    @paused.setter
    def paused(self, paused: bool) -> None:
        if paused != self.paused:
            self._limit_ns = self.now_ns if paused else None

    def step(self, duration_ns: int) -> None:
        """Advance paused time by a duration, as fast as the events run."""
        if self._limit_ns is not None:
            self._limit_ns += max(0, duration_ns)

    def go_to(self, target_ns: int | None, wakeup: Wakeup) -> bool:
        if self._limit_ns is not None:
            return self._step_to(target_ns, self._limit_ns, wakeup)
        if target_ns is None:
            return not wakeup.wait(None)
        self.now_ns = max(self.now_ns, target_ns)
        return True

    def _step_to(self, target_ns: int | None, limit_ns: int, wakeup: Wakeup) -> bool:
        """Advance within the steps of a paused clock; wait behind them."""
        if target_ns is None or target_ns > limit_ns:
            self.now_ns = max(self.now_ns, limit_ns)
            return not wakeup.wait(None)
        self.now_ns = max(self.now_ns, target_ns)
        return True


class PacedClock(VirtualClock):
    """Virtual time that advances at ``factor`` times wall time.

    Args:
        factor: seconds of virtual time per second of wall time, > 0.
        start_ns: initial virtual time.
    """

    is_paced = True
    jumps = False

    def __init__(self, factor: float = 1.0, start_ns: int = 0) -> None:
        super().__init__(start_ns)
        self._factor = self._checked(factor)
        self._anchor_wall_s = time.perf_counter()
        self._anchor_ns = start_ns
        self._first: tuple[float, int] | None = None
        self.lag_s = 0.0

    @property
    def factor(self) -> float:
        return self._factor

    @factor.setter
    def factor(self, factor: float) -> None:
        self._factor = self._checked(factor)
        self._anchor()

    @property
    def real_time_factor(self) -> float:
        """Virtual time divided by wall time since the first wait; 0.0 before."""
        if self._first is None:
            return 0.0
        wall_s = time.perf_counter() - self._first[0]
        return (self.now_ns - self._first[1]) / 1e9 / wall_s if wall_s > 0 else 0.0

    def go_to(self, target_ns: int | None, wakeup: Wakeup) -> bool:
        if self._limit_ns is not None:
            reached = self._step_to(target_ns, self._limit_ns, wakeup)
            self._anchor()  # time continues from here
            return reached
        if target_ns is None:
            return not wakeup.wait(None)
        if self._first is None:
            self._anchor()
            self._first = (self._anchor_wall_s, self.now_ns)
        due_s = self._anchor_wall_s + (target_ns - self._anchor_ns) / 1e9 / self._factor
        left_s = due_s - time.perf_counter()
        if left_s > 0 and wakeup.wait(left_s):
            return False
        self.now_ns = max(self.now_ns, target_ns)
        self.lag_s = max(0.0, time.perf_counter() - due_s)
        if self.lag_s > _MAX_CATCH_UP_S:
            self._anchor()
        return True

    def _anchor(self) -> None:
        self._anchor_wall_s = time.perf_counter()
        self._anchor_ns = self.now_ns

    @staticmethod
    def _checked(factor: float) -> float:
        if not 0.0 < factor < float("inf"):
            raise InvalidValueError(
                f"real-time factor must be finite and > 0, got {factor!r}"
            )
        return float(factor)


def monotonic_ns() -> int:
    """Return the machine's steady clock, for STEADY_TIME and measurements."""
    return time.perf_counter_ns()


class SteadyClock:
    """Steady time of the machine and CPU time of the calling thread."""

    @property
    def now_s(self) -> float:
        """Seconds since any start; never steps back."""
        return time.perf_counter()

    @property
    def thread_cpu_s(self) -> float:
        """CPU time of the calling thread in seconds."""
        return time.thread_time()

    def sleep(self, duration_s: float) -> None:
        """Block the calling thread."""
        threading.Event().wait(duration_s)


class Stopwatch:
    """Wall time since construction, for progress reports and limits."""

    def __init__(self) -> None:
        self._start_ns = time.perf_counter_ns()

    @property
    def elapsed_s(self) -> float:
        return (time.perf_counter_ns() - self._start_ns) / 1e9
