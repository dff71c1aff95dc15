"""Servers of services: a query stays open until its request is answered."""

import threading
from collections.abc import Callable
from typing import Any

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

# Requests that wait at one server, and how many of the longest ones; more are refused.
# Whoever may ask can fill a slow server, but not the memory.
MOST_WAITING = 10_000
MOST_OF_THE_LONGEST = 2
_LONGEST_REASON = 2000


class ZenohService(ServicePort):
    """A queryable that hands requests on and remembers whose they are.

    Args:
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
        "_queryable",
        "_sink",
        "matches",
        "waiting",
    )

    def __init__(
        self,
        session: zenoh.Session,
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
        self._queryable: Any = session.declare_queryable(
            key,
            zenoh.handlers.Callback(self._on_query, indirect=False),
            complete=True,
            allowed_origin=zenoh.Locality.REMOTE,
        )

    def reply(self, request_id: RequestId, message: Any) -> None:
        query = self.waiting.take(request_id)
        if query is None:  # of a client in this process, or answered already
            return
        attachment = Attachment(
            request_id.sequence, self._now_ns(), request_id.client_gid
        )
        with query:
            query.reply(self._key, serialize(message), attachment=attachment.encode())

    def fail(self, request_id: RequestId, reason: str) -> None:
        query = self.waiting.take(request_id)
        if query is not None:
            _refuse(query, reason)

    def close(self) -> None:
        if self._queryable is None:
            return
        queryable, self._queryable = self._queryable, None
        self._closed(self)
        queryable.undeclare()
        for query in self.waiting.take_all():
            _refuse(query, "the server was closed")

    # -- on Zenoh's threads ------------------------------------------------------

    def _on_query(self, query: zenoh.Query) -> None:
        try:
            request = self._checked(query)
            self.waiting.add(request.id, query, len(query.payload or b""))
        except DecodeError as error:
            name = self.matches.endpoint.topic
            text = f"service {name}: request ignored: {error}"
            self._complaints.once(("request", name), text)
            _refuse(query, str(error))
            return
        self._heard.last_ns = request.received_ns
        self._sink(request)

    def _checked(self, query: zenoh.Query) -> Request:
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
        message = deserialize(payload.to_bytes(), interface.Request)
        return Request(message, source_ns, self._now_ns(), RequestId(gid, sequence))


class Waiting:
    """Queries that are not answered yet, and the bytes that they hold.

    Args:
        most_bytes: of all together.
    """

    def __init__(self, most_bytes: int) -> None:
        self._most_bytes = most_bytes
        self._queries: dict[RequestId, tuple[zenoh.Query, int]] = {}
        self._bytes = 0
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return len(self._queries)

    def check_room(self, size: int) -> None:
        """Whether one more fits, before it is decoded.

        Raises:
            DecodeError: too many wait already.
        """
        if len(self._queries) >= MOST_WAITING or self._bytes + size > self._most_bytes:
            raise DecodeError(
                f"{len(self._queries)} requests with {self._bytes} bytes wait already"
            )

    def add(self, request_id: RequestId, query: zenoh.Query, size: int) -> None:
        """Remember it until it is taken.

        Raises:
            DecodeError: there is one of that client under that number.
        """
        with self._lock:
            if request_id in self._queries:
                raise DecodeError(f"request {request_id.sequence} is under way already")
            self._queries[request_id] = query, size
            self._bytes += size

    def take(self, request_id: RequestId) -> zenoh.Query | None:
        """Remember it no longer; None: it was not there."""
        with self._lock:
            query, size = self._queries.pop(request_id, (None, 0))
            self._bytes -= size
        return query

    def take_all(self) -> list[zenoh.Query]:
        """Remember none of them any longer."""
        with self._lock:
            queries = [query for query, _ in self._queries.values()]
            self._queries.clear()
            self._bytes = 0
        return queries


def _refuse(query: zenoh.Query, reason: str) -> None:
    with query:
        query.reply_err(reason.encode()[:_LONGEST_REASON])
