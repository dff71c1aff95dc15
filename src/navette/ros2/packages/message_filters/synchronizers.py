"""Synchronizers: sets of messages, one of each input, with matching stamps."""

# ruff: noqa: N802 - the names are message_filters'

from collections.abc import Sequence
from typing import Any

from navette.errors import InvalidValueError, MessageError
from navette.ros2.packages.message_filters.simple_filter import SimpleFilter, clock_of
from navette.ros2.packages.message_filters.stamps import StampReader, as_time
from navette.runtime import Clock, Duration

#: A message that is older than all waiting ones by more belongs to a new run.
_NEW_RUN_NS = 1_000_000_000
#: Messages of one input that wait for the other inputs, by stamp (ns).
Queue = dict[int, Any]


class TimeSynchronizer(SimpleFilter):
    """Filter that outputs one message of each input when all have the same stamp.

    Stamps may arrive in any order. Where a full queue would drop a message that is
    more than 1 s older than all waiting ones, a new run has begun (a bag that loops):
    all queues are cleared.

    Args:
        fs: the input filters.
        queue_size: number of waiting messages per input; the one with the oldest stamp
            is dropped first.
    """

    def __init__(self, fs: Sequence[Any], queue_size: int) -> None:
        super().__init__()
        if queue_size < 1:
            raise InvalidValueError(f"queue_size {queue_size}: must be at least 1")
        self.queue_size = queue_size
        self.clock: Clock = clock_of(*fs)
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[Any]) -> None:
        """Connect the input filters and clear the queues."""
        self.queues: list[Queue] = [{} for _ in fs]
        self.input_connections = [
            f.registerCallback(self.add, queue, index)
            for index, (f, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Add a message of one input.

        Raises:
            MessageError: the message has no header with a stamp.
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
        is_full = len(queue) == self.queue_size
        if is_full and stamp_ns < min(queue) - _NEW_RUN_NS:
            # Otherwise this and all further messages would be dropped, as those with
            # the oldest stamp.
            for each in self.queues:
                each.clear()
        queue[stamp_ns] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]

    def _emit(self, stamps_ns: Sequence[int]) -> None:
        """Output the messages with these stamps, one of each queue."""
        # Removed first, so that a callback that raises does not receive them again.
        self.signalMessage(
            *[q.pop(t) for q, t in zip(self.queues, stamps_ns, strict=True)]
        )


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Filter that outputs one message of each input when their stamps are close.

    An arriving message is combined with the waiting messages of the other inputs within
    ``slop`` of it, the nearest first; the last input varies fastest. The first set
    whose stamps lie less than ``slop`` apart is output. As in ROS 2, the result depends
    on the order of arrival.

    Args:
        fs, queue_size: as for :class:`TimeSynchronizer`.
        slop: longest time between the stamps of a set, in s; 0 matches no set.
        allow_headerless: use the time of arrival, which depends on delays, for messages
            without a stamp; otherwise these are dropped.
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
        stamp = self._stamps.read(msg)
        if stamp is None:
            return
        stamp_ns = stamp.nanoseconds
        self._put(msg, my_queue, stamp_ns)
        if stamp_ns not in my_queue:  # dropped: the queue is full of newer messages
            return
        choices = [
            [stamp_ns] if index == my_queue_index else self._near(queue, stamp_ns)
            for index, queue in enumerate(self.queues)
        ]
        chosen = _first_close(choices, self.slop.nanoseconds)
        if chosen is not None:
            self._emit(chosen)

    def _near(self, queue: Queue, stamp_ns: int) -> list[int]:
        """Return the stamps within slop, the nearest and then the earliest first."""
        slop_ns = self.slop.nanoseconds
        near = [each for each in queue if abs(each - stamp_ns) <= slop_ns]
        return sorted(near, key=lambda each: abs(each - stamp_ns))


def _first_close(choices: Sequence[Sequence[int]], slop_ns: int) -> list[int] | None:
    """Return the first combination within slop; the last input varies fastest.

    A partial combination that is too wide is not completed, which keeps the cost low
    with many waiting messages.
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
