"""Rate: keep a loop of one's own at a frequency."""

from collections.abc import Callable
from typing import Any

from navette.runtime.context import Context
from navette.runtime.exceptions import ROSInterruptException
from navette.runtime.ros_clock import Clock


class Rate:
    """``sleep()`` lets the rest of the current period pass. Made by ``create_rate``.

    While it sleeps, events go on: from within a callback as well as from plain code
    (``while ok(): …; rate.sleep()``), whether another thread spins or nobody does.
    """

    def __init__(
        self,
        period_ns: int,
        clock: Clock,
        context: Context,
        on_destroy: Callable[["Rate"], None],
    ) -> None:
        self._period_ns = period_ns
        self._clock = clock
        self._context = context
        self._next_ns = clock.now_ns + period_ns
        self._destroyed = False
        self._on_destroy: Callable[[Any], None] = on_destroy

    def sleep(self) -> None:
        """Return at the end of the period; at once if that is past.

        Raises:
            ROSInterruptException: the context was shut down.
        """
        if not self._context.ok() or self._destroyed:
            raise ROSInterruptException
        now = self._clock.now_ns
        if self._next_ns > now + self._period_ns:  # the clock was set back
            self._next_ns = now + self._period_ns
        self._clock.sleep_until_ns(self._next_ns, self._context)
        if not self._context.ok():
            raise ROSInterruptException
        now = self._clock.now_ns
        # Late by periods: skip them and keep the phase.
        missed = max(0, (now - self._next_ns) // self._period_ns)
        self._next_ns += (missed + 1) * self._period_ns

    def destroy(self) -> None:
        self._destroyed = True
        self._on_destroy(self)
