"""The newest messages of a filter, to be asked for by time."""

# ruff: noqa: N802 - the names are message_filters'

from typing import Any

from navette.errors import InvalidValueError
from navette.ros2.packages.message_filters.simple_filter import SimpleFilter, clock_of
from navette.ros2.packages.message_filters.stamps import (
    NEW_RUN_NS,
    StampReader,
    as_time,
)
from navette.runtime import Time


class Cache(SimpleFilter):
    """Keeps the ``cache_size`` messages that arrived last, in order of arrival.

    When stamps go back by more than a second (a bag that loops), it begins anew.

    Args:
        f: the filter to listen to.
        allow_headerless: keep messages without a stamp by the time of their arrival,
            which depends on delays; otherwise they are dropped.
    """

    def __init__(
        self, f: Any, cache_size: int = 1, allow_headerless: bool = False
    ) -> None:
        super().__init__()
        if cache_size < 1:
            raise InvalidValueError(f"cache_size {cache_size}: wanted at least 1")
        self.cache_size = cache_size
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Time] = []
        self.clock = clock_of(f)
        self._stamps = StampReader(self.clock, allow_headerless=allow_headerless)
        self.connectInput(f)

    @property
    def allow_headerless(self) -> bool:
        return self._stamps.allow_headerless

    def connectInput(self, f: Any) -> None:
        """Listen to a filter."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Keep a message and hand it on."""
        stamp = self._stamps.read(msg)
        if stamp is None:
            return
        latest = self.getLatestTime()
        if latest is not None and stamp.nanoseconds < latest.nanoseconds - NEW_RUN_NS:
            self.cache_msgs.clear()
            self.cache_times.clear()
        self.cache_times.append(stamp)
        self.cache_msgs.append(msg)
        if len(self.cache_msgs) > self.cache_size:
            del self.cache_msgs[0]
            del self.cache_times[0]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Any, to_stamp: Any) -> list[Any]:
        """The messages from one time to another, both included.

        Raises:
            InvalidValueError: the interval ends before it starts.
        """
        start, end = as_time(from_stamp), as_time(to_stamp)
        if end < start:
            raise InvalidValueError(f"interval from {start} to {end} ends too early")
        return [msg for msg, time in self._pairs() if start <= time <= end]

    def getElemAfterTime(self, stamp: Any) -> Any:
        """The first kept message at the time or after it; None if there is none."""
        time = as_time(stamp)
        return next((msg for msg, kept in self._pairs() if kept >= time), None)

    def getElemBeforeTime(self, stamp: Any) -> Any:
        """The last kept message at the time or before it; None if there is none."""
        time = as_time(stamp)
        older = [msg for msg, kept in self._pairs() if kept <= time]
        return older[-1] if older else None

    def getLatestTime(self) -> Time | None:
        """Stamp of the message that arrived last; None if there is none."""
        return self.cache_times[-1] if self.cache_times else None

    getLastestTime = getLatestTime

    def getOldestTime(self) -> Time | None:
        """Stamp of the message that arrived first; None if there is none."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """The first kept message that is not older than the last; None if none."""
        latest = self.getLatestTime()
        return None if latest is None else self.getElemAfterTime(latest)

    def _pairs(self) -> list[tuple[Any, Time]]:
        return list(zip(self.cache_msgs, self.cache_times, strict=True))
