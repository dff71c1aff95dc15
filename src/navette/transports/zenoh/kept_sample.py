"""The sample of a latched publisher that no remote subscription has received yet.

An advanced publisher keeps only samples that it sends, so they must be serialised,
which takes 2 to 45 ms for a map of 14 MB. Until a subscription exists in another
session, the newest sample is kept here as it is, and serialised if a late joiner
queries it (decision 0017).
"""

import contextlib
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

import zenoh

from navette.errors import MessageError
from navette.msgs import serialize
from navette.transports.encoded import Encoded
from navette.transports.zenoh.callbacks import direct
from navette.transports.zenoh.log_once import LogOnce

# Ends the key of a subscriber's first query, which all its publishers receive.
_ALL = "/@adv/**"
# Samples published while a slow link takes a reply; of more, the oldest are dropped.
_MOST_WAITING = 10


class Sample(NamedTuple):
    """A message that its publisher does not change any more, or its CDR."""

    message: Any
    attachment: bytes

    def encoded(self) -> bytes:
        data = self.message
        if data.__class__ is not bytes:
            data = data.data if data.__class__ is Encoded else serialize(data)
        return bytes(data)


class KeptSample:
    """Answers late joiners as the cache of an advanced publisher does.

    It ends when a remote subscription exists: then the advanced publisher begins. A
    late joiner may still be receiving the kept sample; what is published meanwhile is
    sent after it, and the publishing thread does not wait.

    Each late joiner queries twice: all publishers of the topic, and each one whose
    token it finds. A reply here has no sequence number of zenoh-ext, by which a
    subscriber drops duplicates, so only the second query is answered.

    Args:
        key: key expression of the publisher's samples.
    """

    def __init__(self, session: zenoh.Session, key: str, log_once: LogOnce) -> None:
        self._session = session
        self._key = key
        self._log_once = log_once
        self._lock = threading.Lock()
        self._sample: Sample | None = None
        self._is_asked = self._has_ended = False
        self._replying = 0
        #: Sends what was published during the replies.
        self._waiting: deque[Callable[[], None]] = deque(maxlen=_MOST_WAITING)
        # Only to know whether subscribers exist: samples are never sent by it.
        self._probe: Any = session.declare_publisher(
            key, allowed_destination=zenoh.Locality.REMOTE
        )
        own = self._probe.id
        self._name = f"{key}/@adv/pub/{own.zid}/{own.eid}/_"
        self._queryable: Any = session.declare_queryable(
            self._name,
            direct(self._on_query),
            # The in-process transport delivers to subscriptions in this session.
            allowed_origin=zenoh.Locality.REMOTE,
        )
        self._token: Any = None

    def replace(self, sample: Sample) -> bool:
        """Keep a sample in place of the older one; return False if a reader exists.

        Zenoh processes a subscriber's declaration before its query: a subscriber that
        is unknown here will query the new sample, or has already set ``_is_asked``.
        """
        has_reader = bool(self._probe.matching_status.matching)
        with self._lock:
            if has_reader or self._is_asked or self._has_ended:
                return False
            self._sample = sample
        if self._token is None:
            # Present subscribers, which Zenoh may not have reported, query at once.
            self._token = self._session.liveliness().declare_token(self._name)
        return True

    def end(self) -> None:
        """Answer no further query."""
        with self._lock:
            self._has_ended, self._sample = True, None

    def defers(self, send: Callable[[], None]) -> bool:
        """Return whether ``send`` is called later, after the last reply."""
        with self._lock:
            if self._replying:
                self._waiting.append(send)
            return bool(self._replying)

    def undeclare(self) -> None:
        self.end()
        for each in (self._token, self._queryable, self._probe):
            if each is not None:
                each.undeclare()

    # The following methods run on Zenoh's threads.

    def _on_query(self, query: zenoh.Query) -> None:
        with query:
            if "_sn" in query.parameters:  # for missed samples: there are none
                return
            is_for_all = str(query.key_expr).endswith(_ALL)
            sample = self._begin_reply(is_answered=not is_for_all)
            if sample is None:
                return
            try:
                self._reply(query, sample)
            finally:
                query.drop()  # the reply is complete before anything follows it
                self._end_reply()

    def _begin_reply(self, *, is_answered: bool) -> Sample | None:
        with self._lock:
            self._is_asked = True
            sample = self._sample if is_answered else None
            self._replying += sample is not None
        return sample

    def _reply(self, query: zenoh.Query, sample: Sample) -> None:
        try:
            data = sample.encoded()
            query.reply(self._key, data, attachment=sample.attachment)
        except MessageError as error:
            text = f"{self._key}: the kept message cannot be sent: {error}"
            self._log_once.warning(("kept", self._key, ""), text)
        except zenoh.ZError:  # the session was closed, or the link was lost
            return

    def _end_reply(self) -> None:
        """Send what waits for the replies, in order, if this was the last one."""
        while True:
            with self._lock:
                if self._replying > 1 or not self._waiting:
                    self._replying -= 1
                    return
                send = self._waiting.popleft()
            with contextlib.suppress(zenoh.ZError):  # the session was closed
                send()
