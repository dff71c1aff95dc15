"""Points in time."""

from navette.runtime.time import Duration, Time

__all__ = ["Duration", "Time"]
