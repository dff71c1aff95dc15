"""Timers and rates."""

from navette.runtime import (
    CallbackGroup,
    Clock,
    ClockType,
    Context,
    Time,
    get_default_context,
)
from navette.runtime.exceptions import InvalidHandle, ROSInterruptException
from navette.runtime.rate import Rate
from navette.runtime.timer import Timer, TimerInfo

__all__ = [
    "CallbackGroup",
    "Clock",
    "ClockType",
    "Context",
    "InvalidHandle",
    "ROSInterruptException",
    "Rate",
    "Time",
    "Timer",
    "TimerInfo",
    "get_default_context",
]
