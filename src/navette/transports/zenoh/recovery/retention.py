"""What a publisher keeps for those that may have missed it."""

import threading
from collections import deque
from collections.abc import Sized
from typing import Any

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


Kept = tuple[int, bytes, Any, int]
"""A sample as it was sent: number, attachment, payload, size."""


class Retention:
    """The last ``depth`` samples, while somebody listens or is to come back.

    Args:
        depth: None: all, within bounds.
        newest: the last number that was sent by a publisher of that name before.
    """

    __slots__ = ("_bytes", "_depth", "_is_wanted", "_kept", "_lock", "_newest")

    def __init__(self, depth: int | None, newest: int = 0) -> None:
        self._is_wanted = False
        self._depth = depth or MOST_OF_ALL
        self._kept: deque[Kept] = deque()
        self._bytes = 0
        self._newest = newest
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
        if self._is_wanted:
            return True
        self._newest = number
        if not listeners:
            return False
        with self._lock:
            self._is_wanted = bool(listeners)
            return self._is_wanted

    def add(self, sample: Kept) -> None:
        """It is about to be sent."""
        kept = self._kept
        with self._lock:
            kept.append(sample)
            self._bytes += sample[3]
            while len(kept) > self._depth or (
                self._bytes > MOST_BYTES and len(kept) > 1
            ):
                self._bytes -= kept.popleft()[3]
            self._newest = sample[0]

    def between(self, ask: Ask) -> tuple[list[Kept], End]:
        """What is there of those numbers, as far as an answer goes, and its end."""
        most = _MOST_LONG if ask.takes_long else _MOST_SHORT
        found: list[Kept] = []
        size = 0
        with self._lock:
            for sample in self._kept:
                number, _, _, bytes_ = sample
                if not ask.first <= number <= ask.last:
                    continue
                size += bytes_
                # The first one goes however long it is, where it may be long at all.
                is_beyond = size > most and (found or not ask.takes_long)
                if is_beyond or len(found) >= _MOST_SAMPLES:
                    return found, End(number - 1, bytes_ > _MOST_SHORT)
                found.append(sample)
            return found, End(min(ask.last, self._newest))

    def end(self, listeners: Sized) -> None:
        """Nobody is owed anything, unless somebody listens by now."""
        with self._lock:
            if not listeners:
                self._is_wanted = False
                self._kept.clear()
                self._bytes = 0
