"""The publishers' side: who may have missed something, and what they get."""

import threading
from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import Protocol

from navette.transports.qos import ReliabilityPolicy
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery.mail import Ask, End, Head, Kind, Letter, letters
from navette.transports.zenoh.recovery.retention import Kept, Retention

# So long samples are kept for one whose link was lost, in ticks (seconds).
GRACE_TICKS = 60
# A publisher that has fallen silent tells where it is, so many ticks afterwards.
_QUIET_TICKS = (1, 2, 4, 8)


class Peers(Protocol):
    """What is known of other sessions."""

    def post(self, to: str, letter: Letter) -> None:
        """Send a letter; it may be lost."""

    def may_return(self, session: str, gid: bytes) -> bool:
        """Whether an endpoint that is not seen any more is one of Navette's that has
        not said that it is closed."""


class Offer:
    """A reliable publisher, with those that listen to it or are owed samples."""

    __slots__ = (
        "gid",
        "key",
        "listeners",
        "matches",
        "owed",
        "quiet",
        "retention",
        "seen",
    )

    def __init__(
        self, gid: bytes, key: str, matches: Matches, retention: Retention
    ) -> None:
        self.gid = gid
        self.key = key
        self.matches = matches
        self.retention = retention
        #: Subscription → its session.
        self.listeners: dict[bytes, str] = {}
        #: Subscription → its session, and how many ticks are left.
        self.owed: dict[bytes, tuple[str, int]] = {}
        self.seen = 0
        self.quiet = 0

    @property
    def head(self) -> Head:
        return Head(self.gid, self.retention.newest)

    def settle(self) -> None:
        """Keep nothing where nobody is owed anything."""
        if not self.owed:
            self.retention.end(self.matches.remotes)

    def fell_silent(self) -> bool:
        """Whether to tell where it is; asked at every tick."""
        newest = self.retention.newest
        self.quiet = self.quiet + 1 if newest == self.seen else 0
        self.seen = newest
        return self.quiet in _QUIET_TICKS


class Offers:
    """The reliable publishers of a session."""

    def __init__(self, peers: Peers) -> None:
        self._peers = peers
        self._offers: dict[bytes, Offer] = {}
        self._by_endpoint: dict[int, Offer] = {}
        self._lock = threading.Lock()

    def add(self, gid: bytes, key: str, matches: Matches, retention: Retention) -> None:
        """A publisher of samples with that key is open, from before it is announced."""
        offer = Offer(gid, key, matches, retention)
        with self._lock:
            self._offers[gid] = offer
            self._by_endpoint[id(matches.endpoint)] = offer
        self._update(offer)

    def remove(self, endpoint: object) -> None:
        """That publisher is about to close: nobody is to wait for it."""
        with self._lock:
            offer = self._by_endpoint.pop(id(endpoint), None)
            if offer is None:
                return
            del self._offers[offer.gid]
            sessions = {*offer.listeners.values(), *(z for z, _ in offer.owed.values())}
        for session in sessions:
            self._peers.post(session, Letter(Kind.CLOSED, (Head(offer.gid, 0),)))

    def on_match(self, endpoint: object, met: bytes | None) -> None:
        """The subscription ``met`` listens to it now; None: one has ceased to."""
        with self._lock:
            offer = self._by_endpoint.get(id(endpoint))
        if offer is not None:
            self._update(offer, met)

    def on_closed(self, gids: Iterable[bytes]) -> None:
        """Those subscriptions do not come back."""
        gone = set(gids)
        self._forget(lambda gid, session: gid in gone)

    def on_bye(self, session: str) -> None:
        """That session does not come back."""
        self._forget(lambda gid, of: of == session)

    def tick(self) -> None:
        """A second has gone by."""
        heads: defaultdict[str, list[Head]] = defaultdict(list)
        with self._lock:
            for offer in self._offers.values():
                if offer.owed:
                    left = {g: (z, n - 1) for g, (z, n) in offer.owed.items() if n > 1}
                    offer.owed = left
                    offer.settle()
                if offer.listeners and offer.fell_silent():
                    for session in set(offer.listeners.values()):
                        heads[session].append(offer.head)
        for session, entries in heads.items():
            for letter in letters(Kind.HEADS, entries):
                self._peers.post(session, letter)

    def answer(self, ask: Ask) -> tuple[str, list[Kept], End]:
        """The key of the topic, and what there is of what is asked for."""
        with self._lock:
            offer = self._offers.get(ask.gid)
        if offer is None:
            return "", [], End(ask.last)
        return offer.key, *offer.retention.between(ask)

    def _update(self, offer: Offer, met: bytes | None = None) -> None:
        now = {
            remote.gid: key.split("/", 3)[2]
            for key, remote in dict(offer.matches.remotes).items()
            if remote.qos.reliability == ReliabilityPolicy.RELIABLE
        }
        with self._lock:
            # One that was lost and is back by now is told anew, too.
            before = offer.listeners.keys() - {met}
            new = {now[gid] for gid in now.keys() - before}
            for gid in offer.listeners.keys() - now.keys():
                session = offer.listeners[gid]
                if self._peers.may_return(session, gid):
                    offer.owed[gid] = session, GRACE_TICKS
            for gid in now:
                offer.owed.pop(gid, None)
            offer.listeners = now
            offer.settle()
            head, offer.quiet = offer.head, 0
        for session in new:
            self._peers.post(session, Letter(Kind.MATCHED, (head,)))

    def _forget(self, is_gone: Callable[[bytes, str], bool]) -> None:
        with self._lock:
            for offer in self._offers.values():
                if not offer.owed:
                    continue
                for gid, (session, _) in list(offer.owed.items()):
                    if is_gone(gid, session):
                        del offer.owed[gid]
                offer.settle()
