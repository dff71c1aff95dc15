"""Clocks and their jumps."""

from navette.runtime import Context, get_default_context
from navette.runtime.exceptions import NotInitializedException
from navette.runtime.ros_clock import (
    Clock,
    ClockChange,
    JumpHandle,
    JumpThreshold,
    ROSClock,
    TimeJump,
)
from navette.runtime.time import ClockType, Duration, Time

__all__ = [
    "Clock",
    "ClockChange",
    "ClockType",
    "Context",
    "Duration",
    "JumpHandle",
    "JumpThreshold",
    "NotInitializedException",
    "ROSClock",
    "Time",
    "TimeJump",
    "get_default_context",
]
