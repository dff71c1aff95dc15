"""Timers and rates."""

from navette.runtime.rate import Rate
from navette.runtime.timer import Timer, TimerInfo

__all__ = ["Rate", "Timer", "TimerInfo"]
