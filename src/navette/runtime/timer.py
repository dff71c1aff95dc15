"""Timers: a callback once per period of a clock."""

from collections.abc import Callable
from typing import Any

from navette.errors import InvalidValueError
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.destroyable import Destroyable
from navette.runtime.events import Entity
from navette.runtime.node_entities import NodeEntities
from navette.runtime.ros_clock import Clock, ClockChange, JumpThreshold, TimeJump
from navette.runtime.signatures import takes_arguments
from navette.runtime.time import ClockType, Duration, Time


class TimerInfo:
    """Expected and actual time of a timer's call."""

    def __init__(
        self,
        *,
        expected_call_time: int = 0,
        actual_call_time: int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        self.expected_call_time = Time(
            nanoseconds=expected_call_time, clock_type=clock_type
        )
        self.actual_call_time = Time(
            nanoseconds=actual_call_time, clock_type=clock_type
        )


class Timer(Destroyable, Entity):
    """Runs a callback every ``timer_period_ns`` of its clock; skips missed periods.

    Created by :meth:`Node.create_timer`.
    """

    __slots__ = (
        "_callback",
        "_clock",
        "_entities",
        "_is_canceled",
        "_is_virtual",
        "_jump_handle",
        "_last_ns",
        "_next_ns",
        "_period_ns",
        "_takes_info",
        "token",
    )

    def __init__(
        self,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup,
        timer_period_ns: int,
        clock: Clock,
        entities: NodeEntities,
        *,
        autostart: bool = True,
    ) -> None:
        self._callback = callback
        self._takes_info = callback is not None and takes_arguments(callback, 1)
        self.group = callback_group
        self._clock = clock
        self._entities = entities
        self._is_virtual = entities.context.clock.is_virtual
        self._period_ns = self._checked(timer_period_ns)
        self._last_ns = clock.now_ns
        self._next_ns = self._last_ns + self._period_ns
        self.token = -1
        self._is_canceled = not autostart
        self._jump_handle = clock.create_jump_callback(
            JumpThreshold(
                min_forward=None,
                min_backward=Duration(nanoseconds=-1),
                on_clock_change=True,
            ),
            post_callback=self._on_jump,
        )
        if autostart:
            self._arm()

    @property
    def callback_group(self) -> CallbackGroup:
        return self.group

    @property
    def clock(self) -> Clock:
        return self._clock

    @property
    def timer_period_ns(self) -> int:
        return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        """Set the period from the next call on (:meth:`reset` applies it now)."""
        self._period_ns = self._checked(int(value))

    @property
    def callback(self) -> Callable[..., Any] | None:
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., Any]) -> None:
        self._callback = callback
        self._takes_info = takes_arguments(callback, 1)

    def is_canceled(self) -> bool:
        return self._is_canceled

    def is_ready(self) -> bool:
        """Return whether the timer is due."""
        return not self._is_canceled and self._clock.now_ns >= self._next_ns

    def cancel(self) -> None:
        """Stop the timer until :meth:`reset`."""
        self._is_canceled = True
        self.token = -1

    def reset(self) -> None:
        """Restart the timer: the next call is one period from now."""
        self._last_ns = self._clock.now_ns
        self._next_ns = self._last_ns + self._period_ns
        self._is_canceled = False
        self._arm()

    def time_since_last_call(self) -> int:
        """Return the nanoseconds since the last call or the start."""
        return self._clock.now_ns - self._last_ns

    def time_until_next_call(self) -> int | None:
        """Return the nanoseconds until the next call (< 0: late); None if cancelled."""
        if self._is_canceled:
            return None
        return self._next_ns - self._clock.now_ns

    def destroy(self) -> None:
        """Stop the timer and remove it from its node."""
        self.cancel()
        self._jump_handle.unregister()
        self._entities.forget(self)

    def origin(self) -> tuple[str, str]:
        return self._entities.full_name, f"timer of {self._period_ns / 1e9:g} s"

    def run(self) -> Any:
        if self._is_canceled:  # while the event was queued
            return None
        now = self._clock.now_ns
        if now < self._next_ns:  # reset, or clock set back, while queued
            self._arm()
            return None
        expected = self._next_ns
        self._last_ns = now
        self._next_ns = expected + self._period_ns
        if self._period_ns == 0:
            self._next_ns = now
        elif self._next_ns <= now:  # late: skip missed periods, keep the phase
            missed = (now - self._next_ns) // self._period_ns + 1
            self._next_ns += missed * self._period_ns
        # Scheduled before the callback, so that events which the callback schedules
        # for the same time run after the timer.
        self._arm()
        if self._callback is None:
            return None
        if not self._takes_info:
            return self._callback()
        return self._callback(
            TimerInfo(
                expected_call_time=expected,
                actual_call_time=now,
                clock_type=self._clock.clock_type,
            )
        )

    def on_clock_set_back(self, step_ns: int) -> None:
        if self._clock.clock_type is not ClockType.STEADY_TIME:
            self._last_ns += step_ns
            self._next_ns += step_ns

    def _arm(self) -> None:
        self._clock.schedule(self._next_ns, self)
        if self._is_canceled:  # meanwhile, by another thread
            self.token = -1

    def _on_jump(self, jump: TimeJump) -> None:
        """Restart the period when the clock is set back or its source changes."""
        if self._is_canceled:
            return
        now = self._clock.now_ns
        changed = jump.clock_change != ClockChange.ROS_TIME_NO_CHANGE
        if changed or self._next_ns - self._period_ns > now:
            self._last_ns = now
            self._next_ns = now + self._period_ns
            self._arm()

    def _checked(self, period_ns: int) -> int:
        if period_ns < 0 or (period_ns == 0 and self._is_virtual):
            reason = " (virtual time would not advance)" if period_ns == 0 else ""
            raise InvalidValueError(
                f"timer period must be > 0 s, got {period_ns / 1e9:g} s{reason}"
            )
        return period_ns
