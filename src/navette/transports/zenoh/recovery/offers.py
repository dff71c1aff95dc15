"""The publishers' side: who may have missed something, and what they get."""

import threading
from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import NamedTuple, Protocol

from navette.transports.qos import ReliabilityPolicy
from navette.transports.zenoh.kin import is_kin
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery.mail import (
    MOST_ENTRIES,
    Ask,
    End,
    Head,
    Kind,
    Letter,
    letters,
)
from navette.transports.zenoh.recovery.retention import Kept, Retention

# So long samples are kept for one whose link was lost, in ticks (seconds).
GRACE_TICKS = 60
# A publisher that has fallen silent tells where it is, so many ticks afterwards.
_QUIET_TICKS = (1, 2, 4, 8)


class Peers(Protocol):
    """What is known of other sessions."""

    def open(self) -> None:
        """Be reachable from now on; opening twice is harmless."""

    def post(self, to: str, letter: Letter) -> None:
        """Send a letter; it may be lost."""

    def may_return(self, session: str, gid: bytes) -> bool:
        """Whether an endpoint that is not seen any more is one of Navette's that has
        not said that it is closed."""


class Debt(NamedTuple):
    """A subscription of that session is owed what comes after that number."""

    session: str
    since: int


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
        self.listeners: dict[bytes, Debt] = {}
        #: Those that are away, and for how many ticks they are waited for.
        self.owed: dict[bytes, tuple[Debt, int]] = {}
        self.seen = 0
        self.quiet = 0

    @property
    def head(self) -> Head:
        return Head(self.gid, self.retention.newest)

    def settle(self) -> None:
        """Keep nothing where nobody is owed anything."""
        if not self.owed and not self.listeners:
            self.retention.end()

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
        self._begin(offer, list(matches.by_gid))

    def remove(self, endpoint: object) -> None:
        """That publisher is about to close: nobody is to wait for it."""
        with self._lock:
            offer = self._by_endpoint.pop(id(endpoint), None)
            if offer is None:
                return
            del self._offers[offer.gid]
            away = [debt for debt, _ in offer.owed.values()]
            sessions = {debt.session for debt in (*offer.listeners.values(), *away)}
        for session in sessions:
            self._peers.post(session, Letter(Kind.CLOSED, (Head(offer.gid, 0),)))

    def on_match(self, endpoint: object, gid: bytes, *, up: bool) -> None:
        """That subscription listens to that publisher from now on, or no longer."""
        with self._lock:
            offer = self._by_endpoint.get(id(endpoint))
        if offer is None:
            return
        if up:
            self._begin(offer, (gid,))
        else:
            self._end(offer, gid)

    def on_where(self, session: str, gids: Iterable[bytes]) -> None:
        """That session has not heard what these publishers owe it."""
        with self._lock:
            offers = [self._offers[gid] for gid in gids if gid in self._offers]
            found = [(offer, _of(offer.listeners, session)) for offer in offers]
        for offer, debts in found:
            if debts:
                # Not how far it has come: that may be on its way.
                self._tell(session, Head(offer.gid, 0), debts)

    def on_closed(self, gids: Iterable[bytes]) -> None:
        """Those subscriptions do not come back."""
        gone = set(gids)
        self._forget(lambda gid, _: gid in gone)

    def on_bye(self, session: str) -> None:
        """That session does not come back."""
        self._forget(lambda gid, of: of == session)

    def tick(self) -> None:
        """A second has gone by."""
        heads: defaultdict[str, list[Head]] = defaultdict(list)
        with self._lock:
            for offer in self._offers.values():
                if offer.owed:
                    offer.owed = {
                        gid: (debt, ticks - 1)
                        for gid, (debt, ticks) in offer.owed.items()
                        if ticks > 1 and self._peers.may_return(debt.session, gid)
                    }
                    offer.settle()
                if offer.listeners and offer.fell_silent():
                    for session in {debt.session for debt in offer.listeners.values()}:
                        heads[session].append(offer.head)
        for session, entries in heads.items():
            for letter in letters(Kind.HEADS, entries):
                self._peers.post(session, letter)

    def listening(self) -> set[str]:
        """Sessions that are there."""
        with self._lock:
            offers = list(self._offers.values())
            return {d.session for offer in offers for d in offer.listeners.values()}

    def awaited(self) -> set[str]:
        """Sessions that are away and owed something."""
        with self._lock:
            offers = list(self._offers.values())
            return {debt.session for offer in offers for debt, _ in offer.owed.values()}

    def answer(self, ask: Ask) -> tuple[str, list[Kept], End]:
        """The key of the topic, and what there is of what is asked for."""
        with self._lock:
            offer = self._offers.get(ask.gid)
        if offer is None:
            return "", [], End(ask.last)
        return offer.key, *offer.retention.between(ask)

    def _begin(self, offer: Offer, gids: Iterable[bytes]) -> None:
        """Those listen now, for the first time or again."""
        matches = offer.matches
        told: defaultdict[str, list[Head]] = defaultdict(list)
        with self._lock:
            found = [(gid, session) for gid in gids if (session := _kin(matches, gid))]
            if found:
                offer.retention.begin()
            head, offer.quiet = offer.head, 0
            for gid, session in found:
                owed, _ = offer.owed.pop(gid, (Debt(session, head.number), 0))
                offer.listeners[gid] = owed
                told[session].append(Head(gid, owed.since))
        if told:
            self._peers.open()
        for session, debts in told.items():
            self._tell(session, head, debts)

    def _end(self, offer: Offer, gid: bytes) -> None:
        """That one listens no longer: it was closed, or its link was lost."""
        with self._lock:
            debt = offer.listeners.pop(gid, None)
            if debt is not None and self._peers.may_return(debt.session, gid):
                offer.owed[gid] = debt, GRACE_TICKS
            offer.settle()

    def _tell(self, session: str, head: Head, debts: Iterable[Head]) -> None:
        every = tuple(debts)
        for i in range(0, len(every), MOST_ENTRIES - 1):
            entries = head, *every[i : i + MOST_ENTRIES - 1]
            self._peers.post(session, Letter(Kind.MATCHED, entries))

    def _forget(self, is_gone: Callable[[bytes, str], bool]) -> None:
        with self._lock:
            for offer in self._offers.values():
                if not offer.owed:
                    continue
                for gid, (debt, _) in list(offer.owed.items()):
                    if is_gone(gid, debt.session):
                        del offer.owed[gid]
                offer.settle()


def _of(listeners: dict[bytes, Debt], session: str) -> list[Head]:
    return [Head(gid, d.since) for gid, d in listeners.items() if d.session == session]


def _kin(matches: Matches, gid: bytes) -> str:
    """The session of a subscription that is to be owed something, if it is there."""
    remote, session = matches.by_gid.get(gid), matches.sessions.get(gid, "")
    if remote is None or remote.qos.reliability != ReliabilityPolicy.RELIABLE:
        return ""
    return session if is_kin(session) else ""
