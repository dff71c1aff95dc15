"""When a message was: by its header, or by the clock if that is allowed."""

import logging
from typing import Any

from navette.runtime import Clock, ClockType, Time

NEW_RUN_NS = 1_000_000_000
"""Stamps that go back by more are of another run: a bag that loops, a reset."""

_LOG = logging.getLogger(__name__)


class StampReader:
    """Gives the stamp of each message that one filter receives.

    Args:
        clock: tells the time of messages without a header.
        allow_headerless: take them by the time of their arrival; else they are
            dropped, which is logged once.
    """

    def __init__(self, clock: Clock, *, allow_headerless: bool) -> None:
        self._clock = clock
        self.allow_headerless = allow_headerless
        self._warned = False

    def read(self, msg: Any) -> Time | None:
        """The stamp; None if there is none and the message is to be dropped."""
        stamp = getattr(getattr(msg, "header", None), "stamp", None)
        if stamp is not None:
            return as_time(stamp)
        if self.allow_headerless:
            now = self._clock.now()
            return Time(nanoseconds=now.nanoseconds, clock_type=ClockType.ROS_TIME)
        if not self._warned:
            self._warned = True
            _LOG.warning(
                "dropped a %s: it has no header with a stamp; allow_headerless=True "
                "takes such messages by the time of their arrival",
                type(msg).__name__,
            )
        return None


def as_time(stamp: Any) -> Time:
    """A stamp message as a Time of the ROS clock; a Time stays."""
    return stamp if hasattr(stamp, "nanoseconds") else Time.from_msg(stamp)
