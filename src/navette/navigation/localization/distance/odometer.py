"""The distance travelled, summed from what a receiver or an odometry says."""

import math
from collections.abc import Sequence
from enum import Enum

from navette.errors import InvalidValueError
from navette.geometry.geodesy import GeoPoint, geodesic_distance


class Step(Enum):
    """What a message did to the distance."""

    STARTED = "started"  # the first one: from here on it is counted
    ADDED = "added"
    WENT_BACK = "time went back"  # a bag began anew, or was set back
    GAP = "gap in time"  # a bag was set forward, or nothing came for long
    REFUSED = "not a number"  # changes nothing


class Odometer:
    """Sums ‖Δposition‖, or Δt·‖velocity‖: one of the two, as it is asked.

    A message is added only if it follows the one before it: after a stamp that jumps
    back, or ahead by more than ``max_gap_ns``, it is where counting goes on, and the
    way in between adds nothing. So a bag that loops, or is set forward or back while
    it plays, adds what it played and no jump.

    Args:
        max_gap_ns: longest time between two messages of one way.

    Raises:
        InvalidValueError: ``max_gap_ns`` is not positive.
    """

    def __init__(self, max_gap_ns: int) -> None:
        if max_gap_ns <= 0:
            raise InvalidValueError(f"max_gap_ns {max_gap_ns}: wanted more than 0")
        self.max_gap_ns = max_gap_ns
        self.reset()

    def reset(self) -> None:
        """Back to 0 m; the next message is the first."""
        self.distance = 0.0
        self.pause()

    def pause(self) -> None:
        """Keep the distance; the next message is where counting goes on."""
        self._last_ns: int | None = None
        self._last: Sequence[float] = ()

    def step_position(self, position: Sequence[float], stamp_ns: int) -> Step:
        """A position (x, y, z), m, in a frame that stays."""
        if not all(map(math.isfinite, position)):
            return Step.REFUSED
        step = self._follow(stamp_ns)
        metres = math.dist(self._last, position) if step is Step.ADDED else 0.0
        self._last = tuple(position)
        return self._add(metres, step)

    def step_place(self, place: GeoPoint, stamp_ns: int) -> Step:
        """A place on the Earth; see :func:`geodesic_distance`."""
        if not place.is_valid:
            return Step.REFUSED
        step = self._follow(stamp_ns)
        adds = step is Step.ADDED
        metres = geodesic_distance(GeoPoint(*self._last), place) if adds else 0.0
        self._last = place
        return self._add(metres, step)

    def step_velocity(self, velocity: Sequence[float], stamp_ns: int) -> Step:
        """A velocity (x, y, z), m/s: that of the time since the message before it."""
        if not all(map(math.isfinite, velocity)):
            return Step.REFUSED
        before_ns = self._last_ns
        step = self._follow(stamp_ns)
        if step is not Step.ADDED or before_ns is None:
            return step
        return self._add((stamp_ns - before_ns) * 1e-9 * math.hypot(*velocity), step)

    def _add(self, metres: float, step: Step) -> Step:
        """Sum up, but for a way without end (numbers near the largest there are)."""
        if not math.isfinite(self.distance + metres):
            return Step.REFUSED
        self.distance += metres
        return step

    def _follow(self, stamp_ns: int) -> Step:
        """How a message of this stamp follows the one before it, which it replaces."""
        before_ns, self._last_ns = self._last_ns, stamp_ns
        if before_ns is None:
            return Step.STARTED
        if stamp_ns < before_ns:
            return Step.WENT_BACK
        return Step.ADDED if stamp_ns - before_ns <= self.max_gap_ns else Step.GAP
