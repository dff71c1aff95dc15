"""Rate: run a loop at a fixed frequency."""

from navette.runtime.exceptions import ROSInterruptException
from navette.runtime.node_entities import NodeEntities
from navette.runtime.ros_clock import Clock


class Rate:
    """Sleeps for the rest of each period. Created by :meth:`Node.create_rate`.

    Events run during ``sleep()``, inside a callback as well as in plain code
    (``while ok(): …; rate.sleep()``), whether or not another thread spins.
    """

    def __init__(self, period_ns: int, clock: Clock, entities: NodeEntities) -> None:
        self._period_ns = period_ns
        self._clock = clock
        self._context = entities.context
        self._next_ns = clock.now_ns + period_ns
        self._destroyed = False
        self._entities = entities

    def sleep(self) -> None:
        """Return at the end of the period, or immediately if that has passed.

        Raises:
            ROSInterruptException: the context was shut down or the rate destroyed.
        """
        if not self._context.ok() or self._destroyed:
            raise ROSInterruptException
        while not self._clock.sleep_until_ns(
            self._end_ns(), self._context, lambda: self._destroyed or self._is_set_back
        ):
            if not self._is_set_back:
                break
        if not self._context.ok() or self._destroyed:
            raise ROSInterruptException
        now = self._clock.now_ns
        # Skip missed periods and keep the phase.
        missed = max(0, (now - self._next_ns) // self._period_ns)
        self._next_ns += (missed + 1) * self._period_ns

    @property
    def _is_set_back(self) -> bool:
        return self._next_ns > self._clock.now_ns + self._period_ns

    def _end_ns(self) -> int:
        """Return the end of the period, which is restarted after a step back."""
        if self._is_set_back:
            self._next_ns = self._clock.now_ns + self._period_ns
        return self._next_ns

    def destroy(self) -> None:
        self._destroyed = True
        self._context.loop.wake()  # another thread may be sleeping
        self._entities.forget(self)
