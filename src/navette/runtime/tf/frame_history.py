"""Transforms of one frame to its parent over time."""

from bisect import bisect_left, bisect_right

from navette.geometry import Transform3
from navette.runtime.tf.exceptions import ExtrapolationException

# Old samples are dropped in batches: deleting from a list's front moves the rest.
_DROP_BATCH = 64


class FrameHistory:
    """Samples in order of their stamps; a static frame has one sample for all times."""

    def __init__(self, child: str, length_ns: int, *, is_static: bool) -> None:
        self.child = child
        self.is_static = is_static
        self._length_ns = length_ns
        # Three parallel lists, because bisection of plain integers is fast.
        self._stamps: list[int] = []
        self._transforms: list[Transform3] = []
        self._parents: list[str] = []
        self._start = 0  # samples before it are too old

    def insert(self, stamp_ns: int, parent_T_child: Transform3, parent: str) -> bool:
        """Add a sample; return False if it is too old.

        A sample with the stamp of an existing one replaces it.
        """
        stamps = self._stamps
        if self.is_static:
            stamps.clear()
            self._transforms.clear()
            self._parents.clear()
        if stamps and stamp_ns < stamps[-1] - self._length_ns:
            return False
        at = len(stamps)
        if stamps and stamp_ns <= stamps[-1]:
            at = bisect_left(stamps, stamp_ns, self._start)
            if stamps[at] == stamp_ns:
                self._transforms[at], self._parents[at] = parent_T_child, parent
                return True
        stamps.insert(at, stamp_ns)
        self._transforms.insert(at, parent_T_child)
        self._parents.insert(at, parent)
        self._drop_old()
        return True

    @property
    def newest_ns(self) -> int:
        return self._stamps[-1]

    @property
    def oldest_ns(self) -> int:
        return self._stamps[self._start]

    @property
    def count(self) -> int:
        return len(self._stamps) - self._start

    @property
    def parent(self) -> str:
        """Parent in the newest sample."""
        return self._parents[-1]

    def at(self, stamp_ns: int) -> tuple[Transform3, str]:
        """Return parent_T_child, interpolated, and the parent at a time.

        Raises:
            ExtrapolationException: the time is outside the interval of the samples.
        """
        stamps = self._stamps
        if self.is_static or stamp_ns == stamps[-1]:
            return self._transforms[-1], self._parents[-1]
        if not stamps[self._start] <= stamp_ns <= stamps[-1]:
            raise self._extrapolation(stamp_ns)
        after = bisect_right(stamps, stamp_ns, self._start)
        before = after - 1
        parent = self._parents[before]
        # If the parent changes in between, the old one holds until the next sample.
        if stamps[before] == stamp_ns or parent != self._parents[after]:
            return self._transforms[before], parent
        fraction = (stamp_ns - stamps[before]) / (stamps[after] - stamps[before])
        earlier, later = self._transforms[before], self._transforms[after]
        return earlier.interpolate(later, fraction), parent

    def _drop_old(self) -> None:
        stamps = self._stamps
        oldest = stamps[-1] - self._length_ns
        while stamps[self._start] < oldest:
            self._start += 1
        if self._start >= _DROP_BATCH:
            del stamps[: self._start]
            del self._transforms[: self._start]
            del self._parents[: self._start]
            self._start = 0

    def _extrapolation(self, stamp_ns: int) -> ExtrapolationException:
        where = "future" if stamp_ns > self._stamps[-1] else "past"
        oldest_s, newest_s = self.oldest_ns / 1e9, self.newest_ns / 1e9
        return ExtrapolationException(
            f"Lookup would require extrapolation into the {where}: transform of "
            f"{self.child!r} in {self.parent!r} requested at {stamp_ns / 1e9:.6f} s, "
            f"the buffer holds {oldest_s:.6f} … {newest_s:.6f} s"
        )
