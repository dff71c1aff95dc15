"""Stamps of messages, from the header or the clock."""

import logging
from typing import Any

from navette.runtime import Clock, ClockType, Time

_LOG = logging.getLogger(__name__)


class StampReader:
    """Reader of the stamps of a filter's messages.

    Args:
        clock: clock for messages without a header.
        allow_headerless: use the time of arrival for these messages; otherwise they
            are dropped, with one log message.
    """

    def __init__(self, clock: Clock, *, allow_headerless: bool) -> None:
        self._clock = clock
        self.allow_headerless = allow_headerless
        self._warned = False

    def read(self, msg: Any) -> Time | None:
        """Return the stamp; None if the message must be dropped."""
        stamp = getattr(getattr(msg, "header", None), "stamp", None)
        if stamp is not None:
            return as_time(stamp)
        if self.allow_headerless:
            now = self._clock.now()
            return Time(nanoseconds=now.nanoseconds, clock_type=ClockType.ROS_TIME)
        if not self._warned:
            self._warned = True
            _LOG.warning(
                "dropped a %s without a stamp in a header; allow_headerless=True "
                "uses the time of arrival for such messages",
                type(msg).__name__,
            )
        return None


def as_time(stamp: Any) -> Time:
    """Convert a stamp message to a Time; return a Time unchanged."""
    return stamp if hasattr(stamp, "nanoseconds") else Time.from_msg(stamp)
