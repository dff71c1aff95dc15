"""What comes back on an ask: samples, pieces of long ones, and an end."""

from collections.abc import Callable
from contextlib import suppress

import zenoh

from navette.errors import DecodeError
from navette.transports.zenoh.recovery.mail import (
    End,
    Piece,
    parse_end,
)


class Recovered:
    """A sample that came in an answer, with what a subscription looks at."""

    __slots__ = ("attachment", "payload", "source_info")

    def __init__(self, attachment: bytes, payload: zenoh.ZBytes) -> None:
        self.attachment = zenoh.ZBytes(attachment)
        self.payload = payload
        self.source_info = None


class Parts:
    """Puts the pieces of one long sample together, over several answers.

    Args:
        most: bytes of a sample; one that claims to be longer is not begun.
    """

    __slots__ = ("_attachment", "_data", "_most", "_total")

    def __init__(self, most: int) -> None:
        self._most = most
        self._attachment = b""
        self._data = bytearray()
        self._total = 0

    def offset(self, number: int) -> int:
        """Where the sample of that number is to go on; 0 where another was begun."""
        begun = int.from_bytes(self._attachment[:8], "little", signed=True)
        return len(self._data) if self._attachment and begun == number else 0

    def add(self, attachment: bytes, piece: Piece, payload: zenoh.ZBytes) -> bool:
        """Whether the piece is the next one of a sample, or begins one."""
        if piece.offset == 0:
            self._attachment = attachment
            self._data.clear()
        size = len(self._data)
        fits = attachment == self._attachment and piece.offset == size
        if not fits or not size + len(payload) <= piece.total <= self._most:
            return False
        self._data += payload.to_bytes()
        self._total = piece.total
        return True

    def whole(self) -> Recovered | None:
        """The sample, once, when its last piece has come."""
        if not self._attachment or len(self._data) < self._total:
            return None
        whole = Recovered(self._attachment, zenoh.ZBytes(self._data))
        self._attachment = b""
        self._data.clear()
        return whole


class Answer:
    """Takes what comes on one ask.

    Args:
        take: called with each sample.
        ended: called once with the end, None where it or something before it did not
            come, and whether anything has come at all.
    """

    def __init__(
        self,
        parts: Parts,
        take: Callable[[Recovered], None],
        ended: Callable[[End | None, bool], None],
    ) -> None:
        self._parts = parts
        self._take = take
        self._ended: Callable[[End | None, bool], None] | None = ended
        self._end: End | None = None
        self._count = 0
        self._has_come = False

    def sample(
        self, attachment: bytes, piece: Piece | None, payload: zenoh.ZBytes
    ) -> None:
        """The next one, in order."""
        self._count += 1
        if piece is None:
            whole: Recovered | None = Recovered(attachment, payload)
        else:
            self._has_come |= self._parts.add(attachment, piece, payload)
            whole = self._parts.whole()
        if whole is not None:
            self._has_come = True
            self._take(whole)

    def reply(self, reply: zenoh.Reply) -> None:
        """The end of the answer."""
        if reply.ok is not None:  # else: out of time
            # What is no end is as good as none: it is asked again.
            with suppress(DecodeError):
                self._end = parse_end(reply.ok.payload.to_bytes())

    def close(self) -> None:
        """No more comes; closing twice is harmless."""
        ended, self._ended = self._ended, None
        if ended is not None:
            is_complete = self._end is not None and self._count >= self._end.sent
            ended(self._end if is_complete else None, self._has_come)
