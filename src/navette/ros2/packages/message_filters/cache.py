"""Cache of the newest messages of a filter, with lookup by time."""

# ruff: noqa: N802 - the names are message_filters'

from typing import Any

from navette.errors import InvalidValueError
from navette.ros2.packages.message_filters.simple_filter import SimpleFilter, clock_of
from navette.ros2.packages.message_filters.stamps import StampReader, as_time
from navette.runtime import Time


class Cache(SimpleFilter):
    """The last ``cache_size`` messages in order of arrival.

    Args:
        f: the input filter.
        allow_headerless: use the time of arrival, which depends on delays, for messages
            without a stamp; otherwise these are dropped.
    """

    def __init__(
        self, f: Any, cache_size: int = 1, allow_headerless: bool = False
    ) -> None:
        super().__init__()
        if cache_size < 1:
            raise InvalidValueError(f"cache_size {cache_size}: must be at least 1")
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
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        stamp = self._stamps.read(msg)
        if stamp is None:
            return
        self.cache_times.append(stamp)
        self.cache_msgs.append(msg)
        if len(self.cache_msgs) > self.cache_size:
            del self.cache_msgs[0]
            del self.cache_times[0]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Any, to_stamp: Any) -> list[Any]:
        """Return the messages of an interval, ends included.

        Raises:
            InvalidValueError: the interval ends before its start.
        """
        start, end = as_time(from_stamp), as_time(to_stamp)
        if end < start:
            raise InvalidValueError(
                f"interval from {start} to {end} ends before its start"
            )
        return [msg for msg, time in self._pairs() if start <= time <= end]

    def getElemAfterTime(self, stamp: Any) -> Any:
        """Return the first message in the cache at or after a time, or None."""
        time = as_time(stamp)
        return next((msg for msg, kept in self._pairs() if kept >= time), None)

    def getElemBeforeTime(self, stamp: Any) -> Any:
        """Return the last message in the cache at or before a time, or None."""
        time = as_time(stamp)
        older = [msg for msg, kept in self._pairs() if kept <= time]
        return older[-1] if older else None

    def getLatestTime(self) -> Time | None:
        """Return the stamp of the message that arrived last, or None."""
        return self.cache_times[-1] if self.cache_times else None

    getLastestTime = getLatestTime

    def getOldestTime(self) -> Time | None:
        """Return the stamp of the message that arrived first, or None."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """Return the first message that is not older than the last one, or None."""
        latest = self.getLatestTime()
        return None if latest is None else self.getElemAfterTime(latest)

    def _pairs(self) -> list[tuple[Any, Time]]:
        return list(zip(self.cache_msgs, self.cache_times, strict=True))
