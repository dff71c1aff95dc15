"""Servers of services: a query stays open until its request is answered."""

import hashlib
import itertools
import threading
from collections.abc import Callable
from typing import Any, NamedTuple

import zenoh

from navette.errors import DecodeError
from navette.msgs import deserialize, get_interface, serialize
from navette.transports.service_ports import (
    Request,
    RequestId,
    RequestSink,
    ServicePort,
)
from navette.transports.zenoh.attachment import Attachment, decode_attachment
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.heard import Heard
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.queryables import Handler

# Requests that wait at one server, and how many of the longest ones; more are refused.
# Whoever may ask can fill a slow server, but not the memory.
MOST_WAITING = 10_000
MOST_OF_THE_LONGEST = 2
_LONGEST_REASON = 2000
_MARK_SIZE = 16


class ZenohService(ServicePort):
    """A queryable that hands requests on and remembers whose they are.

    Args:
        declare: takes the queries from now on; returns what ends that.
        now_ns: the time here, for the stamps.
        heard: notes that something came.
        closed: called once when the port is closed.
    """

    #: It numbers nothing.
    last = 0

    __slots__ = (
        "_closed",
        "_complaints",
        "_heard",
        "_key",
        "_longest",
        "_now_ns",
        "_sink",
        "_undeclare",
        "matches",
        "waiting",
    )

    def __init__(
        self,
        declare: Callable[[str, Handler], Callable[[], None]],
        key: str,
        sink: RequestSink,
        matches: Matches,
        *,
        complaints: Complaints,
        max_message_bytes: int,
        heard: Heard,
        now_ns: Callable[[], int],
        closed: Callable[["ZenohService"], None],
    ) -> None:
        self.matches = matches
        self.waiting = Waiting(MOST_OF_THE_LONGEST * max_message_bytes)
        self._key = key
        self._sink = sink
        self._complaints = complaints
        self._heard = heard
        self._longest = max_message_bytes
        self._now_ns = now_ns
        self._closed = closed
        self._undeclare: Callable[[], None] | None = declare(key, self._on_query)

    def reply(self, request_id: RequestId, message: Any) -> None:
        queries = self.waiting.take(request_id)
        if not queries:  # of a client in this process, or answered already
            return
        number, now_ns, gid = request_id.sequence, self._now_ns(), request_id.client_gid
        attachment = Attachment(number, now_ns, gid).encode()
        data = serialize(message)
        for query in queries:
            with query:
                query.reply(self._key, data, attachment=attachment)

    def fail(self, request_id: RequestId, reason: str) -> None:
        for query in self.waiting.take(request_id):
            _refuse(query, reason)

    def close(self) -> None:
        if self._undeclare is None:
            return
        undeclare, self._undeclare = self._undeclare, None
        self._closed(self)
        undeclare()
        for query in self.waiting.take_all():
            _refuse(query, "the server was closed")

    # -- on Zenoh's threads ------------------------------------------------------

    def _on_query(self, query: zenoh.Query) -> None:
        try:
            request = self._taken(query)
        except DecodeError as error:
            name = self.matches.endpoint.topic
            text = f"service {name}: request ignored: {error}"
            self._complaints.once(("request", name, str(error)), text)
            _refuse(query, str(error))
            return
        self._heard.last_ns = self._now_ns()
        if request is not None:
            self._sink(request)

    def _taken(self, query: zenoh.Query) -> Request | None:
        """What is to be done; None: what is under way already."""
        payload, attachment = query.payload, query.attachment
        if payload is None or attachment is None:
            raise DecodeError("without a payload or an attachment")
        if len(payload) > self._longest:
            raise DecodeError(
                f"{len(payload)} bytes: longer than {self._longest} "
                "(NAVETTE_MAX_MESSAGE_BYTES)"
            )
        self.waiting.check_room(len(payload))
        sequence, source_ns, gid = decode_attachment(attachment.to_bytes())
        if other := self.matches.astray_from(gid):
            raise DecodeError(f"sent to {other}; a link is being renewed")
        interface: Any = get_interface(self.matches.endpoint.type_name)
        data = payload.to_bytes()
        message = deserialize(data, interface.Request)
        ticket = self.waiting.add(attachment.to_bytes(), query, data)
        if not ticket:
            return None
        request_id = RequestId(gid, sequence, ticket)
        return Request(message, source_ns, self._now_ns(), request_id)


class _Wait(NamedTuple):
    """One request: who is to hear the answer, its bytes, how it is known again."""

    queries: list[zenoh.Query]
    size: int
    mark: bytes


class Waiting:
    """Queries that are not answered yet, and the bytes that they hold.

    The same request may come twice, by two ways: it is done once, and both are told.
    Another one under the same client's name and number is a request of its own: it may
    be a stranger's, and which of the two is cannot be known.

    Args:
        most_bytes: of all together.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most_bytes = most_bytes
        #: By ticket, and the tickets by what the requests are known by.
        self._waits: dict[int, _Wait] = {}
        self._tickets: dict[bytes, int] = {}
        self._next = itertools.count(1)
        self._count = 0
        self._bytes = 0
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return self._count

    def check_room(self, size: int) -> None:
        """Whether one more fits, before it is decoded.

        Raises:
            DecodeError: too many wait already.
        """
        if self._count >= MOST_WAITING or self._bytes + size > self._most_bytes:
            raise DecodeError(
                f"{self._count} requests with {self._bytes} bytes wait already"
            )

    def add(self, attachment: bytes, query: zenoh.Query, data: bytes) -> int:
        """Remember it until it is taken: its ticket; 0 where it is there already."""
        mark = hashlib.blake2b(attachment + data, digest_size=_MARK_SIZE).digest()
        size = len(data)
        with self._lock:
            self._count += 1
            self._bytes += size
            twin = self._tickets.get(mark)
            if twin is not None:
                self._waits[twin].queries.append(query)
                return 0
            ticket = self._tickets[mark] = next(self._next)
            self._waits[ticket] = _Wait([query], size, mark)
        return ticket

    def take(self, request_id: RequestId) -> list[zenoh.Query]:
        """Remember it no longer: those who asked; nobody where it was not there."""
        with self._lock:
            wait = self._waits.pop(request_id.ticket, None)
            if wait is None:
                return []
            del self._tickets[wait.mark]
            self._count -= len(wait.queries)
            self._bytes -= wait.size * len(wait.queries)
        return wait.queries

    def take_all(self) -> list[zenoh.Query]:
        """Remember none of them any longer."""
        with self._lock:
            queries = [query for wait in self._waits.values() for query in wait.queries]
            self._waits.clear()
            self._tickets.clear()
            self._count = self._bytes = 0
        return queries


def _refuse(query: zenoh.Query, reason: str) -> None:
    with query:
        query.reply_err(reason.encode()[:_LONGEST_REASON])
