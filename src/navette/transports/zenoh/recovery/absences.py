"""Endpoints that are not seen any more: which of them may come back.

*Left* is who has said so (a letter), whose process is known to be gone (this machine's
processes are looked at, another one's sessions are asked about theirs), and who is no
session of Navette's. All others are *lost*: their link is, and nobody can know more.
"""

import threading
from collections.abc import Iterable

from navette.transports.zenoh.kin import has_died, is_kin, runs_beside

# Until its token is gone, too; another one may have its name after that.
_CLOSED_TICKS = 5
# Sessions and endpoints remembered; a hostile peer may make up any number.
_MOST_REMEMBERED = 20_000
# Sessions that are asked about one of their machine; and what is read of one letter.
MOST_ASKED = 4


class Absences:
    """Who has left; safe from any thread."""

    def __init__(self) -> None:
        #: Endpoint → ticks for which this is remembered.
        self._closed: dict[bytes, int] = {}
        self._left: dict[str, None] = {}
        self._lock = threading.Lock()

    def may_return(self, session: str, gid: bytes) -> bool:
        """Whether that endpoint, of that session, is lost and not left."""
        return (
            is_kin(session)
            and session not in self._left
            and gid not in self._closed
            and not has_died(session)
        )

    def on_closed(self, gids: list[bytes]) -> None:
        """Those endpoints do not come back."""
        with self._lock:
            for gid in gids[: _MOST_REMEMBERED - len(self._closed)]:
                self._closed[gid] = _CLOSED_TICKS

    def on_opened(self, gid: bytes) -> None:
        """One is there; it may have the name of one that was closed."""
        with self._lock:
            self._closed.pop(gid, None)

    def on_left(self, session: str) -> None:
        """That session does not come back."""
        with self._lock:
            if session not in self._left and len(self._left) >= _MOST_REMEMBERED:
                del self._left[next(iter(self._left))]
            self._left[session] = None

    def tick(self) -> None:
        """A second has gone by."""
        with self._lock:
            self._closed = {g: n - 1 for g, n in self._closed.items() if n > 1}


def witnesses(lost: str, there: Iterable[str]) -> list[str]:
    """Of the sessions that are there, some that can see whether that one has died."""
    return [zid for zid in there if runs_beside(zid, lost)][:MOST_ASKED]
