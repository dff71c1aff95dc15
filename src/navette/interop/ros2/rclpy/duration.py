"""Durations."""

from navette.runtime.time import Duration, Infinite

__all__ = ["Duration", "Infinite"]
