"""Which reliable subscription here hears which publisher, of which session."""

import threading
from collections.abc import Iterable

from navette.transports.base import Endpoint
from navette.transports.zenoh.kin import is_kin
from navette.transports.zenoh.recovery.hearer import Hearer
from navette.transports.zenoh.recovery.mail import Head

# Publishers whose session is remembered, also when they are away.
_MOST_HOMES = 20_000


class Hearing:
    """The reliable subscriptions of a session, and whom they hear; any thread."""

    def __init__(self) -> None:
        #: Endpoint → gid and subscription; gid → subscription.
        self._own: dict[int, tuple[bytes, Hearer]] = {}
        self._by_gid: dict[bytes, Hearer] = {}
        #: Publisher → those that hear it now; and its session, if that is Navette's.
        self._heard: dict[bytes, set[Hearer]] = {}
        self._homes: dict[bytes, str] = {}
        #: What letters say of publishers whose tokens have not been read.
        self._claimed: dict[bytes, str] = {}
        self._lock = threading.Lock()

    def add(self, gid: bytes, hearer: Hearer) -> None:
        """A subscription is open, from before it is announced."""
        with self._lock:
            self._own[id(hearer.matches.endpoint)] = gid, hearer
            self._by_gid[gid] = hearer
            for publisher in list(hearer.matches.by_gid):
                self._hear(publisher, hearer)

    def remove(self, endpoint: object) -> tuple[bytes, Hearer | None, set[str]]:
        """That subscription is about to close: its gid, and the sessions it heard."""
        with self._lock:
            own_gid, hearer = self._own.pop(id(endpoint), (b"", None))
            if hearer is None:
                return b"", None, set()
            self._by_gid.pop(own_gid, None)
            heard = [gid for gid, by in self._heard.items() if hearer in by]
            for gid in heard:
                self._unhear(gid, hearer)
            homes = {self._homes[gid] for gid in heard if gid in self._homes}
        return own_gid, hearer, homes

    def on_match(self, publisher: Endpoint, endpoint: object, *, up: bool) -> None:
        """That subscription hears that publisher from now on, or no longer."""
        with self._lock:
            _, hearer = self._own.get(id(endpoint), (b"", None))
            if hearer is None:
                return
            if not up:
                self._unhear(publisher.gid, hearer)
                return
            self._hear(publisher.gid, hearer)
            is_known = publisher.gid in self._homes
        if not is_known:  # it writes no letters: nothing waits for one
            hearer.start(publisher.gid)

    def on_matched(self, session: str, entries: Iterable[Head]) -> bytes:
        """A publisher (the first entry) of that session knows of subscriptions here."""
        head, *ours = entries
        with self._lock:
            if not self._is_home(head.gid, session):
                return b""
            found = [(self._by_gid.get(gid), number) for gid, number in ours]
        for hearer, number in found:
            if hearer is not None:
                hearer.start_after(head.gid, number)
                hearer.reach(*head)
        return head.gid

    def on_head(self, session: str, head: Head) -> None:
        """A publisher of that session has come so far."""
        with self._lock:
            if self._homes.get(head.gid) != session:
                return
            hearers = list(self._heard.get(head.gid, ()))
        for hearer in hearers:
            hearer.reach(*head)

    def sessions(self) -> set[str]:
        """Of publishers that are heard now."""
        with self._lock:
            return {self._homes[gid] for gid in self._heard if gid in self._homes}

    def knows(self, hearer: Hearer) -> bool:
        """Whether it is open."""
        return id(hearer.matches.endpoint) in self._own

    def home(self, gid: bytes) -> str | None:
        """Of which session of Navette's the publisher is, also when it is away."""
        return self._homes.get(gid) or self._claimed.get(gid)

    def hears(self, hearer: Hearer, gid: bytes) -> bool:
        """Whether it does now."""
        return hearer in self._heard.get(gid, ())

    # -- inside, under the lock --------------------------------------------------

    def _hear(self, gid: bytes, hearer: Hearer) -> None:
        self._heard.setdefault(gid, set()).add(hearer)
        session = hearer.matches.sessions.get(gid)
        if session is None:
            return  # gone again
        self._claimed.pop(gid, None)
        if is_kin(session):
            _note(self._homes, gid, session)

    def _unhear(self, gid: bytes, hearer: Hearer) -> None:
        heard = self._heard.get(gid, set())
        heard.discard(hearer)
        if not heard:
            self._heard.pop(gid, None)

    def _is_home(self, gid: bytes, session: str) -> bool:
        """Whether it may be: a token says more than a letter."""
        if gid in self._homes:
            return self._homes[gid] == session
        if is_kin(session) and gid not in self._heard:
            _note(self._claimed, gid, session)
        return self._claimed.get(gid) == session


def _note(homes: dict[bytes, str], gid: bytes, session: str) -> None:
    if gid not in homes and len(homes) >= _MOST_HOMES:
        del homes[next(iter(homes))]
    homes[gid] = session
