"""Points in time."""

from navette.runtime.time import NS_PER_S as S_TO_NS
from navette.runtime.time import ClockType, Duration, Time

__all__ = [
    "ClockType",
    "Duration",
    "S_TO_NS",
    "Time",
]
