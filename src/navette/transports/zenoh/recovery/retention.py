"""What a publisher keeps for those that may have missed it."""

import threading
from collections import deque
from collections.abc import Iterator
from typing import Any

from navette.transports.zenoh.recovery.mail import Ask, End, Piece

# Of one publisher. The newest sample is kept however long it is.
MOST_BYTES = 64 * 1024 * 1024
# What a publisher that keeps all keeps for this.
MOST_OF_ALL = 1000

# One answer: short samples go together, with all else on the link; long ones in pieces
# that give way to it. No message must be longer than what a link takes at once: it
# would keep its sender waiting, and others of the same priority.
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
        with self._lock:
            return self._newest

    def keeps(self, number: int) -> bool:
        """Whether the sample of that number is to be added.

        Who begins to be owed something has it either added, or sees here that this
        number was before its time.
        """
        if self._is_wanted:
            return True
        with self._lock:
            if not self._is_wanted:
                self._newest = number
            return self._is_wanted

    def begin(self) -> None:
        """Somebody is owed what comes from now on."""
        with self._lock:
            self._is_wanted = True

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
                begin = ask.offset if ask.takes_long and number == ask.first else 0
                size += max(bytes_ - begin, 0)
                if size > most and ask.takes_long and not found:
                    return [sample], End(number - 1, is_long=True)
                if size > most or len(found) >= _MOST_SAMPLES:
                    return found, End(number - 1, bytes_ > _MOST_SHORT)
                found.append(sample)
            return found, End(min(ask.last, self._newest))

    def end(self) -> None:
        """Nobody is owed anything any more."""
        with self._lock:
            self._is_wanted = False
            self._kept.clear()
            self._bytes = 0


def pieces(sample: Kept, ask: Ask) -> Iterator[tuple[bytes, Any]]:
    """Attachments and payloads of the replies that carry a sample."""
    number, attachment, payload, size = sample
    if size <= _MOST_SHORT:
        yield attachment, payload
        return
    begin = ask.offset if number == ask.first else 0
    end = min(size, begin + _MOST_LONG)
    data = payload.to_bytes()
    for start in range(begin, end, _MOST_SHORT):
        piece = Piece(start, size)
        yield attachment + piece.encode(), data[start : min(start + _MOST_SHORT, end)]
