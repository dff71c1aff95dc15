"""Mapping between the time of a clock and the time of a recording."""

from navette.bags.play.options import check_rate


class Playhead:
    """Converts clock time to recording time and back.

    Both in integer nanoseconds. The rate is the exact fraction of the floating-point
    number, so that the mapping does not drift: bag = bag₀ + (now − now₀) · rate.
    """

    def __init__(self, rate: float = 1.0) -> None:
        self._now_ns = 0
        self._bag_ns = 0
        self.moves = False
        self._set_ratio(rate)

    def at(self, now_ns: int) -> int:
        """Return the position in the recording at this time."""
        if not self.moves:
            return self._bag_ns
        return self._bag_ns + (now_ns - self._now_ns) * self._num // self._den

    def due_ns(self, bag_ns: int) -> int:
        """Return the time at which a position is reached (rounded up).

        Valid only while playing.
        """
        ahead = bag_ns - self._bag_ns
        return self._now_ns - (-ahead * self._den // self._num)

    def place(self, now_ns: int, bag_ns: int) -> None:
        self._now_ns, self._bag_ns = now_ns, bag_ns

    def set_moving(self, now_ns: int, *, moves: bool) -> None:
        self.place(now_ns, self.at(now_ns))
        self.moves = moves

    def set_rate(self, now_ns: int, rate: float) -> None:
        """Set the rate from now on.

        Raises:
            InvalidValueError: the rate is out of range.
        """
        check_rate(rate)
        self.place(now_ns, self.at(now_ns))
        self._set_ratio(rate)

    def _set_ratio(self, rate: float) -> None:
        self.rate = check_rate(rate)
        self._num, self._den = self.rate.as_integer_ratio()
