"""Durations."""

from navette.runtime.time import NS_PER_S as S_TO_NS
from navette.runtime.time import Duration, Infinite

__all__ = [
    "Duration",
    "Infinite",
    "S_TO_NS",
]
