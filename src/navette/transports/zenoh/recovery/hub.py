"""Recovery between the sessions of Navette: letters, asks and answers, and a tick."""

import atexit
import contextlib
import os
import threading
import weakref
from collections.abc import Callable
from functools import partial
from typing import Any

import zenoh

from navette.errors import DecodeError
from navette.transports.base import Endpoint, TransportObserver
from navette.transports.leaving import wait_for_at_end
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.graph import Matches
from navette.transports.zenoh.recovery.answer import Answer
from navette.transports.zenoh.recovery.errands import Errands
from navette.transports.zenoh.recovery.mail import (
    Ask,
    Kind,
    Letter,
    ask_key,
    mail_key,
    parse_ask,
    parse_letter,
    parse_sender,
    recovered_key,
)
from navette.transports.zenoh.recovery.offers import Offers
from navette.transports.zenoh.recovery.retention import pieces
from navette.transports.zenoh.recovery.wants import Hearer, Wants

_TICK_S = 1.0
# The most that an answer may take, on a very slow link; a lost link ends it at once.
_ANSWER_S = 60.0
_JOIN_S = 1.5
_SHORT, _LONG = zenoh.Priority.DATA, zenoh.Priority.DATA_LOW
# Sessions and endpoints remembered; a hostile peer may make up any number.
_MOST_REMEMBERED = 20_000

_open: "weakref.WeakSet[Recovery]" = weakref.WeakSet()


class Recovery(TransportObserver):
    """What a session does so that what is reliable and was lost on the way comes still.

    ``offers`` are the reliable publishers here, ``wants`` what the reliable
    subscriptions here miss. Nothing is declared and no thread runs before the first
    of them.

    Args:
        zid: of ``session``.
        max_message_bytes: longer messages are not put together.
    """

    def __init__(
        self,
        session: zenoh.Session,
        zid: str,
        domain_id: int,
        complaints: Complaints,
        max_message_bytes: int,
    ) -> None:
        self._session = session
        self._zid = zid
        self._domain_id = domain_id
        self._complaints = complaints
        self._errands = Errands("navette-recovery")
        self.offers = Offers(self)
        self.wants = Wants(zid, self._get, self.post, self._errands, max_message_bytes)
        self._peers: dict[str, None] = {}
        self._closed: dict[bytes, None] = {}
        self._left: dict[str, None] = {}
        self._stop = threading.Event()
        self._ticker: threading.Thread | None = None
        self._declared: list[Any] = []
        self._listening: dict[Hearer, Any] = {}
        self._lock = threading.Lock()

    def open(self) -> None:
        """Be reachable from now on; opening twice is harmless."""
        with self._lock:
            if self._declared or self._stop.is_set():
                return
            remote = zenoh.Locality.REMOTE
            box = mail_key(self._domain_id, self._zid, "*")
            desk = ask_key(self._domain_id, self._zid)
            self._declared = [
                self._session.declare_subscriber(
                    box, _direct(self._on_letter), allowed_origin=remote
                ),
                self._session.declare_queryable(
                    desk, _direct(self._on_ask), complete=True, allowed_origin=remote
                ),
            ]
            if not _open:
                # Now, not when this was imported: before the sessions are closed.
                atexit.register(_farewell_all)
            _open.add(self)

    def leave(self, matches: Matches) -> None:
        """That endpoint here is about to close."""
        self.offers.remove(matches.endpoint)
        hearer = self.wants.remove(matches.endpoint)
        if hearer is not None:
            self._cease(hearer)

    def _cease(self, hearer: Hearer) -> None:
        with self._lock:
            listening = self._listening.pop(hearer, None)
        if listening is not None and not self._session.is_closed():
            listening.undeclare()

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
        self._errands.close(_JOIN_S)
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
            self.wants.on_match(publisher, subscription, up=up)
        else:
            if up:  # it may have the name of one that was closed
                self._closed.pop(subscription.gid, None)
            self.offers.on_match(publisher, subscription.gid if up else None)

    # -- letters ---------------------------------------------------------------

    def post(self, to: str, letter: Letter) -> None:
        """Send a letter; it may be lost."""
        if letter.kind != Kind.BYE:
            if self._stop.is_set():
                return  # all has been said
            self._start_ticking()
        # Closed by now, at the exit of the process: nobody reads it.
        with contextlib.suppress(zenoh.ZError):
            self._session.put(
                mail_key(self._domain_id, to, self._zid),
                letter.encode(),
                congestion_control=zenoh.CongestionControl.DROP,
                allowed_destination=zenoh.Locality.REMOTE,
            )

    def may_return(self, session: str, gid: bytes) -> bool:
        """Whether an endpoint that is not seen any more is one of Navette's that has
        not said that it is closed."""
        return (
            session in self._peers
            and session not in self._left
            and gid not in self._closed
        )

    def _on_letter(self, sample: zenoh.Sample) -> None:
        try:
            sender = parse_sender(str(sample.key_expr))
            letter = parse_letter(sample.payload.to_bytes())
        except DecodeError as error:
            text = f"recovery: letter ignored: {error}"
            self._complaints.once(("letter",), text)
            return
        is_new = _remember(self._peers, sender)
        if letter.kind == Kind.MATCHED:
            if is_new:
                self.post(sender, Letter(Kind.HELLO))
            for head in letter.entries:
                self.wants.on_matched(sender, head)
        elif letter.kind == Kind.HEADS:
            for head in letter.entries:
                self.wants.on_head(sender, head)
        elif letter.kind == Kind.CLOSED:
            gids = [head.gid for head in letter.entries]
            for gid in gids:
                _remember(self._closed, gid)
            self.offers.on_closed(gids)
            self.wants.on_closed(gids)
        elif letter.kind == Kind.BYE:
            _remember(self._left, sender)
            self.offers.on_bye(sender)
            self.wants.on_bye(sender)

    # -- asks and answers --------------------------------------------------------

    def _get(self, session: str, ask: Ask, hearer: Hearer, answer: Answer) -> None:
        priority = _LONG if ask.takes_long else _SHORT
        try:
            self._listen(hearer)
            self._session.get(
                ask_key(self._domain_id, session),
                zenoh.handlers.Callback(answer.reply, answer.close, indirect=False),
                consolidation=zenoh.ConsolidationMode.NONE,
                timeout=_ANSWER_S,
                payload=ask.encode(),
                priority=priority,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        except zenoh.ZError:  # closed
            answer.close()

    def _listen(self, hearer: Hearer) -> None:
        """For what is asked for; declared when something is, for the first time."""
        with self._lock:
            if hearer not in self._listening:
                self._listening[hearer] = self._session.declare_subscriber(
                    recovered_key(hearer.key, self._zid),
                    _direct(partial(self.wants.on_sample, hearer)),
                    allowed_origin=zenoh.Locality.REMOTE,
                )

    def _on_ask(self, query: zenoh.Query) -> None:
        """Leave it to another thread: an answer may have to wait for the link."""
        try:
            payload = query.payload
            ask = parse_ask(b"" if payload is None else payload.to_bytes())
        except DecodeError as error:
            text = f"recovery: ask ignored: {error}"
            self._complaints.once(("ask",), text)
            query.drop()
            return
        if not self._errands.do(partial(self._answer, query, ask)):
            query.drop()  # and it is asked again

    def _answer(self, query: zenoh.Query, ask: Ask) -> None:
        topic_key, samples, end = self.offers.answer(ask)
        key, sent = recovered_key(topic_key, ask.by), 0
        # The link may be lost in the middle, or the session closed: asked again.
        with query, contextlib.suppress(zenoh.ZError):
            for sample in samples:
                for attachment, payload in pieces(sample, ask):
                    if self._stop.is_set():
                        return
                    self._send(key, payload, attachment, ask)
                    sent += 1
            end = end._replace(sent=sent)
            query.reply(ask_key(self._domain_id, self._zid), end.encode())

    def _send(self, key: str, payload: Any, attachment: bytes, ask: Ask) -> None:
        # A put, and in the topic's name: what may not be put there is not recovered.
        self._session.put(
            key,
            payload,
            attachment=attachment,
            priority=_LONG if ask.takes_long else _SHORT,
            congestion_control=zenoh.CongestionControl.BLOCK,
            allowed_destination=zenoh.Locality.REMOTE,
        )

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


def _remember(known: dict[Any, None], what: Any) -> bool:
    """Whether it is new; the oldest is forgotten where there are too many."""
    if what in known:
        return False
    if len(known) >= _MOST_REMEMBERED:
        known.pop(next(iter(known)), None)
    known[what] = None
    return True


def _direct(callback: Callable[[Any], None]) -> Any:
    return zenoh.handlers.Callback(callback, indirect=False)


# A forked child has none of the threads, and nothing to say.
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_open.clear)


def _farewell_all() -> None:
    for recovery in list(_open):
        recovery.farewell()
