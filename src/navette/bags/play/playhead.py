"""The place in a recording, as time goes by."""

from navette.bags.play.options import check_rate


class Playhead:
    """Turns the time of who plays into the time of the recording, and back.

    Both in integer nanoseconds. The rate is taken as the exact fraction that the
    floating-point number is, so that nothing drifts: bag = bag₀ + (now − now₀) · rate.
    """

    def __init__(self, rate: float = 1.0) -> None:
        self._now_ns = 0
        self._bag_ns = 0
        self.moves = False
        self._set_ratio(rate)

    @property
    def rate(self) -> float:
        return self._rate

    def at(self, now_ns: int) -> int:
        """The place in the recording at this time."""
        if not self.moves:
            return self._bag_ns
        return self._bag_ns + (now_ns - self._now_ns) * self._num // self._den

    def due_ns(self, bag_ns: int) -> int:
        """When, if nothing changes, the place in the recording is reached (rounded up).

        Only while it moves.
        """
        ahead = bag_ns - self._bag_ns
        return self._now_ns - (-ahead * self._den // self._num)

    def place(self, now_ns: int, bag_ns: int) -> None:
        """Be at this place now."""
        self._now_ns, self._bag_ns = now_ns, bag_ns

    def set_moving(self, now_ns: int, *, moves: bool) -> None:
        """Go on or stand still from now on."""
        self.place(now_ns, self.at(now_ns))
        self.moves = moves

    def set_rate(self, now_ns: int, rate: float) -> None:
        """Go faster or slower from now on.

        Raises:
            InvalidValueError: no rate.
        """
        check_rate(rate)
        self.place(now_ns, self.at(now_ns))
        self._set_ratio(rate)

    def _set_ratio(self, rate: float) -> None:
        self._rate = check_rate(rate)
        self._num, self._den = self._rate.as_integer_ratio()
