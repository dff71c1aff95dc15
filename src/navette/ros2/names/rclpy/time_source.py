"""Simulated time."""

from navette.runtime.time_source import CLOCK_TOPIC, USE_SIM_TIME_NAME, TimeSource

__all__ = [
    "CLOCK_TOPIC",
    "TimeSource",
    "USE_SIM_TIME_NAME",
]
