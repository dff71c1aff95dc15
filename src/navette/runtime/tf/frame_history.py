"""The transform of one frame to its parent over time."""

from bisect import bisect_right, insort
from collections import deque

from navette.geometry import Transform3
from navette.runtime.tf.exceptions import ExtrapolationException

Sample = tuple[int, Transform3, str]
"""Stamp (ns), parent_T_child, parent."""


class FrameHistory:
    """Samples in order of their stamps; static frames keep one for all times."""

    __slots__ = ("_length_ns", "_samples", "child", "is_static")

    def __init__(self, child: str, length_ns: int, *, is_static: bool) -> None:
        self.child = child
        self.is_static = is_static
        self._length_ns = length_ns
        self._samples: deque[Sample] = deque()

    def insert(self, stamp_ns: int, parent_T_child: Transform3, parent: str) -> bool:
        """Add a sample; False if it is older than the buffer reaches."""
        samples = self._samples
        sample = (stamp_ns, parent_T_child, parent)
        if self.is_static:
            samples.clear()
        if not samples or stamp_ns > samples[-1][0]:
            samples.append(sample)
        elif stamp_ns <= samples[-1][0] - self._length_ns:
            return False
        else:
            self._insert_late(sample)
        oldest = samples[-1][0] - self._length_ns
        while samples[0][0] < oldest:
            samples.popleft()
        return True

    @property
    def newest_ns(self) -> int:
        return self._samples[-1][0]

    @property
    def oldest_ns(self) -> int:
        return self._samples[0][0]

    @property
    def parent(self) -> str:
        """The newest sample's parent."""
        return self._samples[-1][2]

    def newest(self) -> Sample:
        return self._samples[-1]

    def at(self, stamp_ns: int) -> tuple[Transform3, str]:
        """Interpolated parent_T_child and the parent at a time.

        Raises:
            ExtrapolationException: before the first or after the last sample.
        """
        samples = self._samples
        last = samples[-1]
        if self.is_static or stamp_ns == last[0]:
            return last[1], last[2]
        if not samples[0][0] <= stamp_ns <= last[0]:
            raise self._extrapolation(stamp_ns)
        index = bisect_right(samples, stamp_ns, key=_stamp)
        before = samples[index - 1]
        if before[0] == stamp_ns:
            return before[1], before[2]
        after = samples[index]
        if before[2] != after[2]:  # given to another parent in between
            return before[1], before[2]
        fraction = (stamp_ns - before[0]) / (after[0] - before[0])
        return before[1].interpolate(after[1], fraction), before[2]

    def _insert_late(self, sample: Sample) -> None:
        """Put a sample that came out of order in its place; the newer word counts."""
        samples = self._samples
        index = bisect_right(samples, sample[0], key=_stamp)
        if index and samples[index - 1][0] == sample[0]:
            samples[index - 1] = sample
        else:
            insort(samples, sample, key=_stamp)

    def _extrapolation(self, stamp_ns: int) -> ExtrapolationException:
        first, last = self._samples[0], self._samples[-1]
        where = "future" if stamp_ns > last[0] else "past"
        return ExtrapolationException(
            f"transform of {self.child!r} in {last[2]!r} asked for at "
            f"{stamp_ns / 1e9:.6f} s, which lies in the {where}: the buffer holds "
            f"{first[0] / 1e9:.6f} … {last[0] / 1e9:.6f} s"
        )


def _stamp(sample: Sample) -> int:
    return sample[0]
