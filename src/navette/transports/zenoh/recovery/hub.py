"""Recovery between the sessions of Navette: matches, letters and a tick."""

import atexit
import os
import threading
import weakref
from collections.abc import Callable

import zenoh

from navette.transports.base import Endpoint, TransportObserver
from navette.transports.leaving import wait_for_at_end
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.kin import has_died, is_kin, runs_beside
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery.absences import (
    MOST_ASKED,
    Absences,
    witnesses,
)
from navette.transports.zenoh.recovery.desk import Desk
from navette.transports.zenoh.recovery.hearing import Hearing
from navette.transports.zenoh.recovery.mail import (
    Head,
    Kind,
    Letter,
    about_sessions,
    sessions_in,
)
from navette.transports.zenoh.recovery.mailbox import Mailbox
from navette.transports.zenoh.recovery.offers import Offers
from navette.transports.zenoh.recovery.starts import Starts
from navette.transports.zenoh.recovery.wants import Wants

_TICK_S = 1.0
_JOIN_S = 1.5

_open: "weakref.WeakSet[Recovery]" = weakref.WeakSet()


class Recovery(TransportObserver):
    """What a session does so that what is reliable and was lost on the way comes still.

    ``offers`` are the reliable publishers here, ``hearing`` the reliable subscriptions,
    ``wants`` what these miss. Nothing is declared before the first subscription here or
    the first that listens to a publisher here, and no thread runs before there is
    something to look at.

    Args:
        zid: of ``session``.
        max_message_bytes: longer messages are not put together.
        on_alive: told of a publisher that says that it is alive, and of its session.
    """

    def __init__(
        self,
        session: zenoh.Session,
        zid: str,
        domain_id: int,
        complaints: Complaints,
        max_message_bytes: int,
        on_alive: Callable[[bytes, str], None],
    ) -> None:
        self._on_alive = on_alive
        self.offers = Offers(self)
        self._stop = threading.Event()
        self._absences = Absences()
        self.hearing = Hearing()
        self._desk = Desk(
            session,
            zid,
            domain_id,
            complaints,
            self.offers,
            self.hearing.knows,
            self._stop,
        )
        self._starts = Starts(self.hearing, self.post, self._start_ticking)
        self.wants = Wants(
            zid,
            self.hearing,
            self._starts,
            self._desk.get,
            self._start_ticking,
            self._desk.errands,
            self.may_return,
            max_message_bytes,
        )
        self._mailbox = Mailbox(session, zid, domain_id, complaints, self._read)
        self._ticker: threading.Thread | None = None
        self._lock = threading.Lock()

    def open(self) -> None:
        """Be reachable from now on; opening twice is harmless."""
        with self._lock:
            if self._mailbox.is_open or self._stop.is_set():
                return
            self._mailbox.open()
            self._desk.open()
            if not _open:
                # Now, not when this was imported: before the sessions are closed.
                atexit.register(_farewell_all)
            _open.add(self)

    def leave(self, matches: Matches) -> None:
        """That endpoint here is about to close."""
        self.offers.remove(matches.endpoint)
        gid, hearer, sessions = self.hearing.remove(matches.endpoint)
        if hearer is None:
            return
        self.wants.drop(hearer)
        self._starts.drop(hearer)
        for session in sessions:
            self.post(session, Letter(Kind.CLOSED, (Head(gid, 0),)))
        self._desk.cease(hearer)

    def farewell(self) -> None:
        """All endpoints here are about to close; said while the session is open."""
        if self._stop.is_set():
            return
        self._stop.set()
        _open.discard(self)
        self._mailbox.say_goodbye()

    def join(self) -> None:
        """Wait for the threads, after the session was closed."""
        self._desk.errands.close(_JOIN_S)
        if self._ticker is not None:
            self._ticker.join(_JOIN_S)

    # -- matches, in the thread that reads the graph -----------------------------

    def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        self._on_match(publisher, subscription, up=True)

    def unmatched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        self._on_match(publisher, subscription, up=False)

    def _on_match(
        self, publisher: Endpoint, subscription: Endpoint, *, up: bool
    ) -> None:
        if publisher.is_remote:
            if publisher.qos.asserts_itself:
                self.open()  # for its letters, also where best effort is enough
            self.hearing.on_match(publisher, subscription, up=up)
        else:
            if up:
                self._absences.on_opened(subscription.gid)
            self.offers.on_match(publisher, subscription.gid, up=up)

    # -- letters ---------------------------------------------------------------

    def post(self, to: str, letter: Letter) -> None:
        """Send a letter; it may be lost."""
        if not self._stop.is_set():  # else all has been said
            self._start_ticking()
            self._mailbox.send(to, letter)

    def assert_alive(self, matches: Matches) -> bool:
        """A publisher tells those who hear it; whether all of them read letters."""
        sessions = {*dict(matches.sessions).values()}
        letter = Letter(Kind.ALIVE, (Head(matches.endpoint.gid, 0),))
        for session in filter(is_kin, sessions):
            self.post(session, letter)
        return all(map(is_kin, sessions))

    def may_return(self, session: str, gid: bytes) -> bool:
        """Whether an endpoint that is not seen any more is one of Navette's that has
        not said that it is closed."""
        return self._absences.may_return(session, gid)

    def _read(self, sender: str, letter: Letter) -> None:
        gids = [head.gid for head in letter.entries]
        if letter.kind == Kind.MATCHED:
            if gids and (matched := self.hearing.on_matched(sender, letter.entries)):
                self.wants.retry(matched)
        elif letter.kind == Kind.HEADS:
            for head in letter.entries:
                self.hearing.on_head(sender, head)
        elif letter.kind == Kind.WHERE:
            self.offers.on_where(sender, gids)
        elif letter.kind == Kind.CLOSED:
            self._on_closed(gids)
        elif letter.kind == Kind.BYE:
            self._on_end(sender)
        elif letter.kind == Kind.ALIVE:
            for gid in gids:
                self._on_alive(gid, sender)
        else:
            self._read_of_death(sender, letter)

    def _read_of_death(self, sender: str, letter: Letter) -> None:
        """Somebody asks whether sessions have died, or says so."""
        sessions = sessions_in(letter)[:MOST_ASKED]
        if letter.kind == Kind.SEEN:
            for answer in about_sessions(Kind.DIED, filter(has_died, sessions)):
                self.post(sender, answer)
            return
        for zid in sessions:
            if runs_beside(zid, sender):
                self._on_end(zid)

    def _on_closed(self, gids: list[bytes]) -> None:
        """Those endpoints do not come back."""
        self._absences.on_closed(gids)
        self.offers.on_closed(gids)
        self.wants.on_closed(gids)
        self._starts.on_closed(gids)

    def _on_end(self, session: str) -> None:
        """That session does not come back."""
        self._absences.on_left(session)
        self.offers.on_bye(session)
        self.wants.on_bye(session)
        self._starts.on_bye(session)

    # -- the tick --------------------------------------------------------------

    def _start_ticking(self) -> None:
        if self._ticker is not None:
            return
        with self._lock:
            if self._ticker is None and not self._stop.is_set():
                self._ticker = threading.Thread(
                    target=self._tick, name="navette-recovery", daemon=True
                )
                self._ticker.start()
                wait_for_at_end(self._ticker)

    def _tick(self) -> None:
        while not self._stop.wait(_TICK_S):
            self.offers.tick()
            self.wants.tick()
            self._starts.tick()
            self._inquire()
            self._absences.tick()

    def _inquire(self) -> None:
        """Whether those that are waited for have died: where they ran, it is known."""
        there = self.offers.listening() | self.hearing.sessions()
        for lost in self.offers.awaited():
            for letter in about_sessions(Kind.SEEN, [lost]):
                for zid in witnesses(lost, there):
                    self.post(zid, letter)


# A forked child has none of the threads, and nothing to say.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_open.clear)


def _farewell_all() -> None:
    for recovery in list(_open):
        recovery.farewell()
