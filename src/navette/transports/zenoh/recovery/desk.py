"""Where a session asks others for samples, and answers those who ask it."""

import contextlib
import threading
from collections.abc import Callable
from functools import partial
from typing import Any

import zenoh

from navette.errors import DecodeError
from navette.transports.zenoh.attachment import GID_SIZE
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.recovery.answer import Answer
from navette.transports.zenoh.recovery.errands import Errands
from navette.transports.zenoh.recovery.hearer import Hearer
from navette.transports.zenoh.recovery.mail import (
    Ask,
    ask_key,
    parse_ask,
    recovered_key,
    split_attachment,
)
from navette.transports.zenoh.recovery.offers import Offers
from navette.transports.zenoh.recovery.retention import pieces

# The most that an answer may take, on a very slow link; a lost link ends it at once.
_ANSWER_S = 60.0
_SHORT, _LONG = zenoh.Priority.DATA, zenoh.Priority.DATA_LOW


class Desk:
    """Asks and answers, in threads of its own where they may have to wait.

    Args:
        zid: of ``session``.
        offers: what there is to answer with.
        is_open: whether a subscription is still one of this session.
        stop: when it is set, what is under way ends.
    """

    def __init__(
        self,
        session: zenoh.Session,
        zid: str,
        domain_id: int,
        complaints: Complaints,
        offers: Offers,
        is_open: Callable[[Hearer], bool],
        stop: threading.Event,
    ) -> None:
        self.errands = Errands("navette-recovery")
        self._session = session
        self._zid = zid
        self._domain_id = domain_id
        self._complaints = complaints
        self._offers = offers
        self._is_open = is_open
        self._stop = stop
        self._queryable: Any = None
        self._listening: dict[Hearer, Any] = {}
        self._under_way: dict[tuple[Hearer, bytes], Answer] = {}
        self._lock = threading.Lock()

    def open(self) -> None:
        """Answer from now on."""
        self._queryable = self._session.declare_queryable(
            ask_key(self._domain_id, self._zid),
            _direct(self._on_ask),
            complete=True,
            allowed_origin=zenoh.Locality.REMOTE,
        )

    def cease(self, hearer: Hearer) -> None:
        """Nothing is asked for that subscription any more."""
        with self._lock:
            listening = self._listening.pop(hearer, None)
        if listening is not None and not self._session.is_closed():
            listening.undeclare()

    def get(self, session: str, ask: Ask, hearer: Hearer, answer: Answer) -> None:
        """Ask that session; what comes is for the subscription."""
        priority = _LONG if ask.takes_long else _SHORT
        self._under_way[hearer, ask.gid] = answer

        def close() -> None:
            self._under_way.pop((hearer, ask.gid), None)
            answer.close()

        try:
            self._listen(hearer)
            self._session.get(
                ask_key(self._domain_id, session),
                zenoh.handlers.Callback(answer.reply, close, indirect=False),
                consolidation=zenoh.ConsolidationMode.NONE,
                timeout=_ANSWER_S,
                payload=ask.encode(),
                priority=priority,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        except zenoh.ZError:  # the session was closed
            close()

    def _listen(self, hearer: Hearer) -> None:
        """For what is asked for; declared when something is, for the first time."""
        with self._lock:
            if hearer not in self._listening:
                self._listening[hearer] = self._session.declare_subscriber(
                    recovered_key(hearer.key, self._zid),
                    _direct(partial(self._on_sample, hearer)),
                    allowed_origin=zenoh.Locality.REMOTE,
                )
        if not self._is_open(hearer):  # closed meanwhile: nobody else ends this
            self.cease(hearer)

    def _on_sample(self, hearer: Hearer, sample: zenoh.Sample) -> None:
        """A sample or a piece of one, if it was asked for."""
        if sample.attachment is None:
            return
        attachment, piece = split_attachment(sample.attachment.to_bytes())
        answer = self._under_way.get((hearer, attachment[-GID_SIZE:]))
        if answer is not None:
            answer.sample(attachment, piece, sample.payload)

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
        if not self.errands.do(partial(self._answer, query, ask)):
            query.drop()  # and it is asked again

    def _answer(self, query: zenoh.Query, ask: Ask) -> None:
        topic_key, samples, end = self._offers.answer(ask)
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


def _direct(callback: Callable[[Any], None]) -> Any:
    return zenoh.handlers.Callback(callback, indirect=False)
