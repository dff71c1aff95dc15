"""What a publisher keeps for those that may have missed it."""

import threading
from collections import deque
from collections.abc import Sized
from typing import Any, NamedTuple

from navette.transports.zenoh.recovery.mail import Ask, End

# Of one publisher. The newest sample is kept however long it is.
MOST_BYTES = 64 * 1024 * 1024
# What a publisher that keeps all keeps for this.
MOST_OF_ALL = 1000

# One answer. Bytes of short samples: what a link takes at once, among all else. The
# answer that may have long ones waits for its turn on the link, and others for it.
_MOST_SAMPLES = 1000
_MOST_SHORT = 48 * 1024
_MOST_LONG = 1024 * 1024


class Kept(NamedTuple):
    """A sample as it was sent."""

    number: int
    attachment: bytes
    payload: Any
    size: int


class Retention:
    """The last ``depth`` samples, while somebody listens or is to come back.

    Args:
        depth: None: all, within bounds.
    """

    __slots__ = ("_bytes", "_depth", "_is_wanted", "_kept", "_lock", "_newest")

    def __init__(self, depth: int | None) -> None:
        self._is_wanted = False
        self._depth = depth or MOST_OF_ALL
        self._kept: deque[Kept] = deque()
        self._bytes = 0
        self._newest = 0
        self._lock = threading.Lock()

    @property
    def newest(self) -> int:
        """The last number that was sent, or that was for nobody."""
        return self._newest

    def admits(self, number: int, listeners: Sized) -> bool:
        """Whether somebody gets it; else it need not be made at all.

        Who begins to listen either is seen here, or sees here that this number was
        before its time. From the first listener on everything is kept, until
        :meth:`end`.
        """
        with self._lock:
            if listeners:
                self._is_wanted = True
            elif not self._is_wanted:
                self._newest = number
            return self._is_wanted

    def add(self, sample: Kept) -> None:
        """It is about to be sent."""
        with self._lock:
            self._kept.append(sample)
            self._bytes += sample.size
            while len(self._kept) > self._depth or (
                self._bytes > MOST_BYTES and len(self._kept) > 1
            ):
                self._bytes -= self._kept.popleft().size
            self._newest = max(self._newest, sample.number)

    def between(self, ask: Ask) -> tuple[list[Kept], End]:
        """What is there of those numbers, as far as an answer goes, and its end."""
        most = _MOST_LONG if ask.takes_long else _MOST_SHORT
        found: list[Kept] = []
        size = 0
        with self._lock:
            for sample in self._kept:
                if not ask.first <= sample.number <= ask.last:
                    continue
                size += sample.size
                # The first one goes however long it is, where it may be long at all.
                is_beyond = size > most and (found or not ask.takes_long)
                if is_beyond or len(found) >= _MOST_SAMPLES:
                    is_long = sample.size > _MOST_SHORT
                    return found, End(sample.number - 1, is_long)
                found.append(sample)
            return found, End(min(ask.last, self._newest))

    def end(self, listeners: Sized) -> None:
        """Nobody is owed anything, unless somebody listens by now."""
        with self._lock:
            if not listeners:
                self._is_wanted = False
                self._kept.clear()
                self._bytes = 0
