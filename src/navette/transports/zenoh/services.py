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
from navette.transports.zenoh.attachment import (
    Attachment,
    check_length,
    decode_attachment,
)
from navette.transports.zenoh.ports import PortOwner, ZenohEntity
from navette.transports.zenoh.queryables import Queryables

# Requests that wait at one server, in number and in multiples of the longest message.
# More are refused: a client can fill a slow server, but not the memory.
MAX_WAITING = 10_000
MAX_WAITING_MESSAGES = 2
_MAX_REASON_BYTES = 2000
_DIGEST_SIZE = 16


class ZenohService(ServicePort):
    """A queryable that passes requests on and keeps their queries until the reply."""

    #: A server numbers nothing.
    last = 0

    def __init__(
        self,
        owner: PortOwner,
        entity: ZenohEntity,
        queryables: Queryables,
        *,
        sink: RequestSink,
    ) -> None:
        self.matches = entity.matches
        max_bytes = MAX_WAITING_MESSAGES * owner.session.settings.max_message_bytes
        self.waiting = WaitingRequests(max_bytes)
        self._owner = owner
        self._key = entity.key
        self._sink = sink
        endpoint = entity.matches.endpoint
        self._undeclare: Callable[[], None] | None = queryables.open(
            entity.key,
            self._on_query,
            is_of_node=endpoint.topic.rpartition("/")[0] == endpoint.node_full_name,
        )

    def reply(self, request_id: RequestId, message: Any) -> None:
        queries = self.waiting.take(request_id)
        if not queries:  # of a client in this process, or answered before
            return
        sequence, gid = request_id.sequence, request_id.client_gid
        attachment = Attachment(sequence, self._owner.clock.now_ns, gid).encode()
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
        self._owner.release(self)
        undeclare()
        for query in self.waiting.take_all():
            _refuse(query, "the server was closed")

    # The following methods run on Zenoh's threads.

    def _on_query(self, query: zenoh.Query) -> None:
        try:
            request = self._accepted(query)
        except DecodeError as error:
            name = self.matches.endpoint.topic
            text = f"service {name}: request ignored: {error}"
            self._owner.session.log_once.warning(("request", name, str(error)), text)
            _refuse(query, str(error))
            return
        self._owner.session.last_received.time_ns = self._owner.clock.now_ns
        if request is not None:
            self._sink(request)

    def _accepted(self, query: zenoh.Query) -> Request | None:
        """Return the request of a query; None if it is in progress already."""
        payload, attachment = query.payload, query.attachment
        if payload is None or attachment is None:
            raise DecodeError("without a payload or an attachment")
        check_length(payload, self._owner.session.settings.max_message_bytes)
        self.waiting.check_room(len(payload))
        sequence, source_ns, gid = decode_attachment(attachment.to_bytes())
        if other := self.matches.publisher_of_other_topic(gid):
            raise DecodeError(f"sent to {other}; a link is being renewed")
        interface: Any = get_interface(self.matches.endpoint.type_name)
        data = payload.to_bytes()
        message = deserialize(data, interface.Request)
        ticket = self.waiting.add(attachment.to_bytes(), query, data)
        if not ticket:
            return None
        request_id = RequestId(gid, sequence, ticket)
        return Request(message, source_ns, self._owner.clock.now_ns, request_id)


class _Waiting(NamedTuple):
    """One request: the queries to answer, its size in bytes, its digest."""

    queries: list[zenoh.Query]
    size: int
    digest: bytes


class WaitingRequests:
    """Queries that are not answered yet, limited in number and bytes.

    The same request may arrive twice, by two routes: it is served once, and both
    queries are answered. Another request with the same client gid and number is a
    request of its own: it may be forged, and the two cannot be distinguished.

    Args:
        max_bytes: limit of all payloads together.
    """

    def __init__(self, max_bytes: int) -> None:
        self._max_bytes = max_bytes
        self._by_ticket: dict[int, _Waiting] = {}
        self._tickets: dict[bytes, int] = {}  # by digest
        self._next_ticket = itertools.count(1)
        self._count = 0
        self._bytes = 0
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return self._count

    def check_room(self, size: int) -> None:
        """Check that one more request fits, before it is decoded.

        Raises:
            DecodeError: too many requests wait.
        """
        if self._count >= MAX_WAITING or self._bytes + size > self._max_bytes:
            raise DecodeError(
                f"{self._count} requests with {self._bytes} bytes wait already"
            )

    def add(self, attachment: bytes, query: zenoh.Query, data: bytes) -> int:
        """Keep a query until :meth:`take`; return its ticket, 0 for a duplicate."""
        digest = hashlib.blake2b(attachment + data, digest_size=_DIGEST_SIZE).digest()
        size = len(data)
        with self._lock:
            self._count += 1
            self._bytes += size
            first = self._tickets.get(digest)
            if first is not None:
                self._by_ticket[first].queries.append(query)
                return 0
            ticket = self._tickets[digest] = next(self._next_ticket)
            self._by_ticket[ticket] = _Waiting([query], size, digest)
        return ticket

    def take(self, request_id: RequestId) -> list[zenoh.Query]:
        """Remove a request; return its queries, none if it was not waiting."""
        with self._lock:
            waiting = self._by_ticket.pop(request_id.ticket, None)
            if waiting is None:
                return []
            del self._tickets[waiting.digest]
            self._count -= len(waiting.queries)
            self._bytes -= waiting.size * len(waiting.queries)
        return waiting.queries

    def take_all(self) -> list[zenoh.Query]:
        """Remove all requests; return their queries."""
        with self._lock:
            queries = [q for each in self._by_ticket.values() for q in each.queries]
            self._by_ticket.clear()
            self._tickets.clear()
            self._count = self._bytes = 0
        return queries


def _refuse(query: zenoh.Query, reason: str) -> None:
    with query:
        query.reply_err(reason.encode()[:_MAX_REASON_BYTES])
