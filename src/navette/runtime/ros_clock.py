"""rclpy's clocks, with callbacks for time jumps.

Under a virtual or paced context every clock returns the context's time. Under the
system clock, ROS time follows ``/clock`` if ``use_sim_time`` is set.
"""

import heapq
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from navette.runtime.clock import monotonic_ns
from navette.runtime.context import Context, get_default_context
from navette.runtime.events import Call
from navette.runtime.exceptions import NotInitializedException
from navette.runtime.handles import HasHandle
from navette.runtime.time import ClockType, Duration, Time


class ClockChange(IntEnum):
    """Change of a clock's source in a jump; values as in rcl."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


@dataclass(frozen=True)
class TimeJump:
    """A jump of a clock: the change of its source and of its time."""

    clock_change: ClockChange
    delta: Duration


class JumpThreshold:
    """Jumps to report; a backward threshold is negative."""

    def __init__(
        self,
        *,
        min_forward: Duration | None,
        min_backward: Duration | None,
        on_clock_change: bool = True,
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds < 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("at least one threshold must be enabled")
        self.min_forward = min_forward
        self.min_backward = min_backward
        self.on_clock_change = on_clock_change

    def is_met_by(self, jump: TimeJump) -> bool:
        changed = jump.clock_change in (
            ClockChange.ROS_TIME_ACTIVATED,
            ClockChange.ROS_TIME_DEACTIVATED,
        )
        if changed and self.on_clock_change:
            return True
        if self.min_forward is not None and jump.delta > self.min_forward:
            return True
        return self.min_backward is not None and jump.delta < self.min_backward


class JumpHandle:
    """Keeps a jump callback registered until :meth:`unregister`."""

    def __init__(
        self,
        clock: "Clock",
        threshold: JumpThreshold,
        pre_callback: Callable[[], None] | None,
        post_callback: Callable[[TimeJump], None] | None,
    ) -> None:
        self._clock = clock
        self.threshold = threshold
        self.pre_callback = pre_callback
        self.post_callback = post_callback
        clock._jump_handles.append(self)

    def unregister(self) -> None:
        if self in self._clock._jump_handles:
            self._clock._jump_handles.remove(self)

    def __enter__(self) -> "JumpHandle":
        return self

    def __exit__(self, *exc_info: object) -> None:
        self.unregister()


class Clock(HasHandle):
    """Clock of a context.

    Args:
        clock_type: ROS_TIME gives a :class:`ROSClock`.
        context: the default context if None.
    """

    def __new__(cls, *args: Any, **kwargs: Any) -> "Clock":
        if cls is Clock and kwargs.get("clock_type") is ClockType.ROS_TIME:
            return super().__new__(ROSClock)
        return super().__new__(cls)

    def __init__(
        self,
        *,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
        context: Context | None = None,
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError(f"clock_type must be a ClockType, got {clock_type!r}")
        self._clock_type = clock_type
        self._context = context or get_default_context()
        self._loop = self._context.loop
        self._jump_handles: list[JumpHandle] = []

    @property
    def clock_type(self) -> ClockType:
        return self._clock_type

    def __repr__(self) -> str:
        return f"Clock(clock_type={self._clock_type.name})"

    @property
    def now_ns(self) -> int:
        """Current time in nanoseconds; cheaper than :meth:`now`."""
        source = self._loop.clock
        if self._clock_type is ClockType.STEADY_TIME and not source.is_virtual:
            return monotonic_ns()
        return source.now_ns

    def now(self) -> Time:
        return Time(nanoseconds=self.now_ns, clock_type=self._clock_type)

    def schedule(self, time_ns: int, entity: Any) -> None:
        """Queue ``entity`` on the loop for a time of this clock; set its token."""
        source = self._loop.clock
        if self._clock_type is ClockType.STEADY_TIME and not source.is_virtual:
            time_ns += source.now_ns - monotonic_ns()
        self._loop.schedule(time_ns, entity)

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], None] | None = None,
        post_callback: Callable[[TimeJump], None] | None = None,
    ) -> JumpHandle:
        if pre_callback is None and post_callback is None:
            raise ValueError("one of pre_callback or post_callback must be callable")
        return JumpHandle(self, threshold, pre_callback, post_callback)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Run events until the time ``until``; see :meth:`sleep_until_ns`."""
        if until.clock_type != self._clock_type:
            raise ValueError(
                f"until has the clock type {until.clock_type.name}, the clock has "
                f"{self._clock_type.name}"
            )
        return self.sleep_until_ns(until.nanoseconds, context or self._context)

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Run events for ``rel_time``; see :meth:`sleep_until_ns`."""
        until_ns = self.now_ns + rel_time.nanoseconds
        return self.sleep_until_ns(until_ns, context or self._context)

    def sleep_until_ns(
        self,
        until_ns: int,
        context: Context,
        interrupted: Callable[[], bool] = lambda: False,
    ) -> bool:
        """Run the context's events until the time, or until ``interrupted`` holds.

        False on shutdown, and if simulated time begins or ends meanwhile.
        """
        if not context.ok():
            raise NotInitializedException("cannot sleep without a valid context")
        was_overridden = self._is_overridden

        def has_other_source() -> bool:
            return self._is_overridden != was_overridden

        def done() -> bool:
            return has_other_source() or self.now_ns >= until_ns or interrupted()

        if context.loop is not self._loop and not self._is_overridden:
            # The clock's own loop, which would ring the alarm, may not be running.
            left_ns = until_ns - self.now_ns
            context.loop.run(until_ns=context.clock.now_ns + left_ns, done=done)
        else:
            alarm = Call(context.loop.wake, context.loop.free_group, "sleep", "")
            self.schedule(until_ns, alarm)
            context.loop.run(done=done)
            alarm.token = -1
        return context.ok() and not has_other_source() and self.now_ns >= until_ns

    @property
    def _is_overridden(self) -> bool:
        """Whether the time comes from ``/clock``."""
        return False


class ROSClock(Clock):
    """Clock of a node; simulated time from ``/clock`` can override it."""

    def __init__(
        self,
        *,
        clock_type: ClockType = ClockType.ROS_TIME,
        context: Context | None = None,
    ) -> None:
        super().__init__(clock_type=clock_type, context=context)
        self._override_ns: int | None = None
        self._waiting: list[tuple[int, int, Any]] = []
        self._tokens = -1  # a token of -1 means cancelled

    @property
    def ros_time_is_active(self) -> bool:
        """Whether simulated time overrides the context's time."""
        return self._override_ns is not None

    @property
    def _is_overridden(self) -> bool:
        return self._override_ns is not None

    @property
    def now_ns(self) -> int:
        if self._override_ns is not None:
            return self._override_ns
        return self._loop.clock.now_ns

    def schedule(self, time_ns: int, entity: Any) -> None:
        if self._override_ns is None:
            self._loop.schedule(time_ns, entity)
            return
        # Negative tokens differ from those of the loop's heap.
        self._tokens -= 1
        entity.token = self._tokens
        heapq.heappush(self._waiting, (time_ns, -self._tokens, entity))

    def set_ros_time_override(self, time: Time) -> None:
        """Set the simulated time and queue the entities that are due."""
        self.set_override_ns(time.nanoseconds)

    def set_override_ns(self, time_ns: int) -> None:
        """Set the simulated time in nanoseconds; the first call activates it."""
        before = self._override_ns
        change = ClockChange.ROS_TIME_NO_CHANGE
        if before is None:
            # As in rcl, whose clocks are not compared.
            change, before = ClockChange.ROS_TIME_ACTIVATED, time_ns
        jump = TimeJump(change, Duration(nanoseconds=time_ns - before))
        handles = [h for h in self._jump_handles if h.threshold.is_met_by(jump)]
        for handle in handles:
            if handle.pre_callback is not None:
                handle.pre_callback()
        self._override_ns = time_ns
        for handle in handles:
            if handle.post_callback is not None:
                handle.post_callback(jump)
        self._release_due(time_ns)

    def _release_due(self, time_ns: int) -> None:
        waiting = self._waiting
        while waiting and waiting[0][0] <= time_ns:
            _, order, entity = heapq.heappop(waiting)
            if entity.token == -order:
                self._loop.ready.append(entity)
        self._loop.wake()

    def clear_override(self) -> None:
        """Return to the context's time."""
        if self._override_ns is None:
            return
        jump = TimeJump(ClockChange.ROS_TIME_DEACTIVATED, Duration())
        handles = [h for h in self._jump_handles if h.threshold.is_met_by(jump)]
        for handle in handles:
            if handle.pre_callback is not None:
                handle.pre_callback()
        self._override_ns = None
        for handle in handles:
            if handle.post_callback is not None:
                handle.post_callback(jump)
        self._loop.wake()
