"""Distance travelled, summed from positions or velocities."""

import math
from collections.abc import Sequence
from enum import Enum

from navette.errors import InvalidValueError
from navette.geometry.geodesy import GeoPoint, geodesic_distance


class Step(Enum):
    """Effect of a message on the distance."""

    STARTED = "started"  # first message: counting starts
    ADDED = "added"
    WENT_BACK = "time went back"  # a bag started again, or was set back
    GAP = "gap in time"  # a bag was set forward, or messages were missing
    REFUSED = "not a number"  # no effect


class Odometer:
    """Sum ‖Δposition‖ or Δt·‖velocity‖.

    A message adds distance only if it follows the previous one. After a stamp that
    jumps back, or ahead by more than ``max_gap_ns``, counting continues from that
    message and the interval adds nothing. So a bag that loops, or is set forward or
    back while it plays, adds no jump.

    Args:
        max_gap_ns: longest time between two consecutive messages.

    Raises:
        InvalidValueError: ``max_gap_ns`` is not positive.
    """

    def __init__(self, max_gap_ns: int) -> None:
        if max_gap_ns <= 0:
            raise InvalidValueError(f"max_gap_ns {max_gap_ns}: must be more than 0")
        self.max_gap_ns = max_gap_ns
        self.reset()

    def reset(self) -> None:
        """Reset to 0 m; the next message is the first."""
        self.distance = 0.0
        self.pause()

    def pause(self) -> None:
        """Keep the distance; continue counting from the next message."""
        self._last_ns: int | None = None
        self._last: Sequence[float] = ()

    def step_position(self, position: Sequence[float], stamp_ns: int) -> Step:
        """Add a position (x, y, z), m, in a fixed frame."""
        if not all(map(math.isfinite, position)):
            return Step.REFUSED
        step = self._follow(stamp_ns)
        metres = math.dist(self._last, position) if step is Step.ADDED else 0.0
        self._last = tuple(position)
        return self._add(metres, step)

    def step_place(self, place: GeoPoint, stamp_ns: int) -> Step:
        """Add a geographic position; see :func:`geodesic_distance`."""
        if not place.is_valid:
            return Step.REFUSED
        step = self._follow(stamp_ns)
        adds = step is Step.ADDED
        metres = geodesic_distance(GeoPoint(*self._last), place) if adds else 0.0
        self._last = place
        return self._add(metres, step)

    def step_velocity(self, velocity: Sequence[float], stamp_ns: int) -> Step:
        """Add a velocity (x, y, z), m/s, of the time since the previous message."""
        if not all(map(math.isfinite, velocity)):
            return Step.REFUSED
        before_ns = self._last_ns
        step = self._follow(stamp_ns)
        if step is not Step.ADDED or before_ns is None:
            return step
        return self._add((stamp_ns - before_ns) * 1e-9 * math.hypot(*velocity), step)

    def _add(self, metres: float, step: Step) -> Step:
        """Add to the distance, unless the sum overflows."""
        if not math.isfinite(self.distance + metres):
            return Step.REFUSED
        self.distance += metres
        return step

    def _follow(self, stamp_ns: int) -> Step:
        """Compare a stamp with the previous one, and store it."""
        before_ns, self._last_ns = self._last_ns, stamp_ns
        if before_ns is None:
            return Step.STARTED
        if stamp_ns < before_ns:
            return Step.WENT_BACK
        return Step.ADDED if stamp_ns - before_ns <= self.max_gap_ns else Step.GAP
