"""Clocks and their jumps."""

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
    "Duration",
    "JumpHandle",
    "JumpThreshold",
    "ROSClock",
    "Time",
    "TimeJump",
]
