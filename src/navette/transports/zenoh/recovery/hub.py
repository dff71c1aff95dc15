"""Recovery between the sessions of Navette: matches, letters and a tick."""

import atexit
import contextlib
import os
import threading
import weakref
from collections.abc import Callable
from typing import Any

import zenoh

from navette.errors import DecodeError
from navette.transports.base import Endpoint, TransportObserver
from navette.transports.leaving import wait_for_at_end
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.kin import has_died, is_kin, runs_beside
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery.desk import Desk
from navette.transports.zenoh.recovery.hearing import Hearing
from navette.transports.zenoh.recovery.mail import (
    Head,
    Kind,
    Letter,
    about_sessions,
    mail_key,
    parse_letter,
    parse_sender,
    sessions_in,
)
from navette.transports.zenoh.recovery.offers import Offers
from navette.transports.zenoh.recovery.starts import Starts
from navette.transports.zenoh.recovery.wants import Wants

_TICK_S = 1.0
_JOIN_S = 1.5
_BEFORE, _BEHIND = zenoh.Priority.INTERACTIVE_HIGH, zenoh.Priority.DATA
# Until its token is gone, too; another one may have its name after that.
_CLOSED_TICKS = 5
# Sessions that are asked about one of their machine; and what is read of one letter.
_MOST_ASKED = 4
# Sessions and endpoints remembered; a hostile peer may make up any number.
_MOST_REMEMBERED = 20_000

_open: "weakref.WeakSet[Recovery]" = weakref.WeakSet()


class Recovery(TransportObserver):
    """What a session does so that what is reliable and was lost on the way comes still.

    ``offers`` are the reliable publishers here, ``hearing`` the reliable subscriptions,
    ``wants`` what these miss. Nothing is declared and no thread runs before the first
    of them.

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
        self._session = session
        self._zid = zid
        self._domain_id = domain_id
        self._complaints = complaints
        self._on_alive = on_alive
        self.offers = Offers(self)
        self._stop = threading.Event()
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
            max_message_bytes,
        )
        #: Whom to say that it is over.
        self._peers: dict[str, None] = {}
        #: Endpoint → ticks for which this is remembered.
        self._closed: dict[bytes, int] = {}
        self._left: dict[str, None] = {}
        self._ticker: threading.Thread | None = None
        self._mailbox: Any = None
        self._lock = threading.Lock()

    def open(self) -> None:
        """Be reachable from now on; opening twice is harmless."""
        with self._lock:
            if self._mailbox is not None or self._stop.is_set():
                return
            self._mailbox = self._session.declare_subscriber(
                mail_key(self._domain_id, self._zid, "*"),
                zenoh.handlers.Callback(self._on_letter, indirect=False),
                allowed_origin=zenoh.Locality.REMOTE,
            )
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
        for session in list(self._peers):
            self.post(session, Letter(Kind.BYE))

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
            if up:  # it may have the name of one that was closed
                with self._lock:
                    self._closed.pop(subscription.gid, None)
            self.offers.on_match(publisher, subscription.gid, up=up)

    # -- letters ---------------------------------------------------------------

    def post(self, to: str, letter: Letter) -> None:
        """Send a letter; it may be lost."""
        _remember(self._peers, to)
        if letter.kind != Kind.BYE:
            if self._stop.is_set():
                return  # all has been said
            self._start_ticking()
        # Closed by now, at the exit of the process: nobody reads it.
        with contextlib.suppress(zenoh.ZError):
            self._session.put(
                mail_key(self._domain_id, to, self._zid),
                letter.encode(),
                # How far a publisher has come is not to be known before its samples
                # are there; all else had better come before them.
                priority=_BEHIND if letter.kind == Kind.HEADS else _BEFORE,
                congestion_control=zenoh.CongestionControl.DROP,
                allowed_destination=zenoh.Locality.REMOTE,
            )

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
        return (
            is_kin(session)
            and session not in self._left
            and gid not in self._closed
            and not has_died(session)
        )

    def _on_letter(self, sample: zenoh.Sample) -> None:
        try:
            sender = parse_sender(str(sample.key_expr))
            letter = parse_letter(sample.payload.to_bytes())
        except DecodeError as error:
            text = f"recovery: letter ignored: {error}"
            self._complaints.once(("letter",), text)
            return
        _remember(self._peers, sender)
        self._read(sender, letter)

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
        sessions = sessions_in(letter)[:_MOST_ASKED]
        if letter.kind == Kind.SEEN:
            for answer in about_sessions(Kind.DIED, filter(has_died, sessions)):
                self.post(sender, answer)
            return
        for zid in sessions:
            if runs_beside(zid, sender):
                self._on_end(zid)

    def _on_closed(self, gids: list[bytes]) -> None:
        """Those endpoints do not come back."""
        with self._lock:
            for gid in gids[: _MOST_REMEMBERED - len(self._closed)]:
                self._closed[gid] = _CLOSED_TICKS
        self.offers.on_closed(gids)
        self.wants.on_closed(gids)
        self._starts.on_closed(gids)

    def _on_end(self, session: str) -> None:
        """That session does not come back."""
        _remember(self._left, session)
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
            with self._lock:
                self._closed = {g: n - 1 for g, n in self._closed.items() if n > 1}

    def _inquire(self) -> None:
        """Whether those that are waited for have died: where they ran, it is known."""
        for lost in self.offers.awaited():
            newest_first = list(self._peers)[::-1]
            beside = [zid for zid in newest_first if runs_beside(zid, lost)]
            for letter in about_sessions(Kind.SEEN, [lost]):
                for zid in beside[:_MOST_ASKED]:
                    self.post(zid, letter)


def _remember(known: dict[Any, None], what: Any) -> bool:
    """Whether it is new; the oldest is forgotten where there are too many."""
    if what in known:
        return False
    if len(known) >= _MOST_REMEMBERED:
        known.pop(next(iter(known)), None)
    known[what] = None
    return True


# A forked child has none of the threads, and nothing to say.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_open.clear)


def _farewell_all() -> None:
    for recovery in list(_open):
        recovery.farewell()
