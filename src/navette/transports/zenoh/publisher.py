"""Publishers: serialise once a message, and only while someone remote listens."""

import threading
from collections.abc import Callable
from functools import partial
from typing import Any

import zenoh
from zenoh import ext

from navette.msgs import serialize
from navette.transports.base import PublisherPort
from navette.transports.encoded import Encoded
from navette.transports.qos import EndpointQos, HistoryPolicy, ReliabilityPolicy
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.heard import Heard
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery import Retention


class ZenohPublisher(PublisherPort):
    """Puts CDR with an attachment; Zenoh keeps the samples of latched topics.

    What it keeps them with, every other session is told of: a latched publisher is
    declared with its first sample. Each node has one for its log, and many say nothing.

    Args:
        qos: as it was announced.
        gid: as hashed from the liveliness token.
        used: the last number that was sent under that gid before.
        heard: when something of the others came last.
        retention: what is kept for those that miss something; None: nothing is.
        asserted: tells those who listen that it is alive; whether all are told.
        closed: called once when the port is closed.
        sent: in lock-step, told the number of each sample; and none may be dropped.
    """

    __slots__ = (
        "_asserted",
        "_closed",
        "_declare",
        "_gid",
        "_heard",
        "_is_open",
        "_latched",
        "_lock",
        "_publisher",
        "_put",
        "_retention",
        "_sent",
        "_session",
        "_used",
        "last",
        "matches",
    )

    def __init__(
        self,
        session: zenoh.Session,
        key: str,
        qos: EndpointQos,
        gid: bytes,
        matches: Matches,
        used: int,
        heard: Heard,
        retention: Retention | None,
        asserted: Callable[[Matches], bool],
        closed: Callable[["ZenohPublisher"], None],
        sent: Callable[[int], None] | None = None,
    ) -> None:
        self.matches = matches
        #: The newest number, also of a sample that nobody remote gets.
        self.last = self._used = used
        self._gid = gid
        self._heard = heard
        self._retention = retention
        self._asserted = asserted
        self._latched = qos.is_latched
        self._closed = closed
        self._sent = sent
        self._session = session
        self._is_open = True
        self._lock = threading.Lock()
        lossless = sent is not None
        self._declare = partial(_declare, session, key, qos, lossless=lossless)
        self._publisher: Any = None
        self._put: Callable[..., None] = self._put_first
        if not qos.is_latched:
            self._publisher = self._declare()
            self._put = self._publisher.put

    def send(self, message: Any, source_ns: int, sequence: int) -> None:
        self.last = sequence
        retention, remotes = self._retention, self.matches.remotes
        is_kept = retention is not None and retention.keeps(sequence)
        if not (is_kept or remotes or self._latched or self._is_awaited(source_ns)):
            return
        attachment = Attachment(sequence, source_ns, self._gid).encode()
        data: Any = message.data if message.__class__ is Encoded else serialize(message)
        if is_kept and retention is not None:
            # Zenoh's own, so that what is kept and what is sent are the same bytes.
            size, data = len(data), zenoh.ZBytes(data)
            retention.add((sequence, attachment, data, size))
        try:
            self._put(data, attachment=attachment)
        except zenoh.ZError:
            if self._is_open and not self._session.is_closed():
                raise
            return  # closed meanwhile, by another thread: nobody hears it
        if self._sent is not None:
            self._sent(sequence)

    def _is_awaited(self, now_ns: int) -> bool:
        """Whether somebody listens whose token has not been read yet (2 µs)."""
        if not self._heard.is_recent(now_ns) or self._sent or self.matches.refused:
            return False
        publisher = self._publisher
        try:
            return publisher is not None and bool(publisher.matching_status.matching)
        except zenoh.ZError:  # the session was closed: nobody listens
            return False

    def assert_alive(self) -> bool:
        return self._asserted(self.matches)

    @property
    def used(self) -> int:
        return self._used

    @property
    def matched_count(self) -> int:
        return len(self.matches.remotes)

    def close(self) -> None:
        with self._lock:
            if not self._is_open:
                return
            self._is_open = self._latched = False
            publisher, self._publisher = self._publisher, None
        self._retention = None
        self._closed(self)  # nothing matches from here on: nothing is sent
        if publisher is not None:
            publisher.undeclare()

    def _put_first(self, data: Any, *, attachment: bytes) -> None:
        with self._lock:
            if not self._is_open:
                return
            if self._publisher is None:
                self._publisher = self._declare()
            put = self._put = self._publisher.put
        put(data, attachment=attachment)


def _declare(
    session: zenoh.Session, key: str, qos: EndpointQos, *, lossless: bool
) -> Any:
    reliable = lossless or qos.reliability == ReliabilityPolicy.RELIABLE
    keeps_all = lossless or qos.history == HistoryPolicy.KEEP_ALL
    options: dict[str, Any] = {
        "reliability": (
            zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT
        ),
        # As rmw_zenoh: a robot must not wait for a slow or lost listener.
        "congestion_control": (
            zenoh.CongestionControl.BLOCK
            if reliable and keeps_all
            else zenoh.CongestionControl.DROP
        ),
        "allowed_destination": zenoh.Locality.REMOTE,
    }
    if not qos.is_latched:
        return session.declare_publisher(key, **options)
    return ext.declare_advanced_publisher(
        session,
        key,
        cache=ext.CacheConfig(max_samples=qos.queue_length or _ALL),
        publisher_detection=True,
        **options,
    )


# What KEEP_ALL keeps for late joiners.
_ALL = 100_000
