"""Sets of messages, one of each input, that belong to one time."""

# ruff: noqa: N802 - the names are message_filters'

from collections.abc import Sequence
from typing import Any

from navette.errors import InvalidValueError, MessageError
from navette.ros2.packages.message_filters.simple_filter import SimpleFilter, clock_of
from navette.ros2.packages.message_filters.stamps import (
    NEW_RUN_NS,
    StampReader,
    as_time,
)
from navette.runtime import Clock, Duration

#: Messages of one input that wait for their set: by stamp (ns).
Queue = dict[int, Any]


class TimeSynchronizer(SimpleFilter):
    """Calls back with one message of each input when all have the same stamp.

    Args:
        fs: the filters to listen to.
        queue_size: how many messages of each input wait for the others; of more, the
            one with the oldest stamp goes. When an input's stamps go back by more than
            a second (a bag that loops), what waited is forgotten.
    """

    def __init__(self, fs: Sequence[Any], queue_size: int) -> None:
        super().__init__()
        if queue_size < 1:
            raise InvalidValueError(f"queue_size {queue_size}: wanted at least 1")
        self.queue_size = queue_size
        self.clock: Clock = clock_of(*fs)
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[Any]) -> None:
        """Listen to the filters; what waited is forgotten."""
        self.queues: list[Queue] = [{} for _ in fs]
        self.input_connections = [
            f.registerCallback(self.add, queue, index)
            for index, (f, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """A message of one input arrived.

        Raises:
            MessageError: it has no header with a stamp.
        """
        if not hasattr(getattr(msg, "header", None), "stamp"):
            raise MessageError(
                f"{type(msg).__name__} has no header with a stamp to synchronize by"
            )
        self._put(msg, my_queue, as_time(msg.header.stamp).nanoseconds)
        common = set.intersection(*(set(queue) for queue in self.queues))
        for each in sorted(common):
            self._emit([each] * len(self.queues))

    def _put(self, msg: Any, queue: Queue, stamp_ns: int) -> None:
        if queue and stamp_ns < max(queue) - NEW_RUN_NS:
            # Else the newest, being the oldest by its stamp, would be dropped for ever.
            for each in self.queues:
                each.clear()
        queue[stamp_ns] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]

    def _emit(self, stamps_ns: Sequence[int]) -> None:
        """Hand on the messages with these stamps, one of each queue."""
        # Taken out first: a callback that raises must not get them again.
        self.signalMessage(
            *[q.pop(t) for q, t in zip(self.queues, stamps_ns, strict=True)]
        )


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Calls back with one message of each input when their stamps are close.

    Each arriving message is tried with those that wait: from every other input those
    within ``slop`` of it, the nearest first (of the first other input all of them
    against the nearest of the last, and so on); the first set whose stamps lie less
    than ``slop`` apart goes out. So the result depends on the order of arrival, as in
    ROS 2.

    Args:
        fs: the filters to listen to.
        queue_size: how many messages of each input wait for the others.
        slop: seconds; at 0 no set is ever close enough.
        allow_headerless: take messages without a stamp by the time of their arrival,
            which depends on delays; otherwise they are dropped.
    """

    def __init__(
        self,
        fs: Sequence[Any],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
    ) -> None:
        super().__init__(fs, queue_size)
        self.slop = Duration(seconds=slop)
        self._stamps = StampReader(self.clock, allow_headerless=allow_headerless)

    @property
    def allow_headerless(self) -> bool:
        return self._stamps.allow_headerless

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """A message of one input arrived."""
        stamp = self._stamps.read(msg)
        if stamp is None:
            return
        stamp_ns = stamp.nanoseconds
        self._put(msg, my_queue, stamp_ns)
        if stamp_ns not in my_queue:  # it was the oldest of too many
            return
        choices = [
            [stamp_ns] if index == my_queue_index else self._near(queue, stamp_ns)
            for index, queue in enumerate(self.queues)
        ]
        chosen = _first_close(choices, self.slop.nanoseconds)
        if chosen is not None:
            self._emit(chosen)

    def _near(self, queue: Queue, stamp_ns: int) -> list[int]:
        """The stamps within slop of one, nearest first; earlier arrival first."""
        slop_ns = self.slop.nanoseconds
        near = [each for each in queue if abs(each - stamp_ns) <= slop_ns]
        return sorted(near, key=lambda each: abs(each - stamp_ns))


def _first_close(choices: Sequence[Sequence[int]], slop_ns: int) -> list[int] | None:
    """The first of all combinations, the last varying fastest, that lies within slop.

    A start of a combination that is too wide already is not completed, so that many
    waiting messages cost little.
    """
    chosen: list[int] = []

    def complete() -> bool:
        if len(chosen) == len(choices):
            return True
        for each in choices[len(chosen)]:
            chosen.append(each)
            if max(chosen) - min(chosen) < slop_ns and complete():
                return True
            chosen.pop()
        return False

    return chosen if complete() else None
