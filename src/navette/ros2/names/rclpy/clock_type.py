"""The kinds of clock."""

from navette.runtime.time import ClockType

__all__ = ["ClockType"]
