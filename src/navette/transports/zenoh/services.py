"""Services: a query for every request, a reply with the same number and gid."""

from collections.abc import Callable
from typing import Any

import zenoh

from navette.errors import DecodeError
from navette.msgs import deserialize, get_interface, serialize
from navette.transports.base import Endpoint
from navette.transports.service_ports import (
    ClientPort,
    Reply,
    ReplySink,
    Request,
    RequestId,
    RequestSink,
    ServicePort,
)
from navette.transports.zenoh.attachment import Attachment, decode_attachment
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.graph import Matches
from navette.transports.zenoh.heard import Heard

# Requests that wait for an answer at one server; more are refused.
_MOST_PENDING = 100_000
_LONGEST_REASON = 2000
# What Zenoh tells in place of a reply when the time is over.
_TIMEOUT = b"Timeout"


class ZenohService(ServicePort):
    """A queryable; queries stay open until they are answered.

    Args:
        now_ns: the time here, for the stamps.
        heard: notes that something came.
        closed: called once when the port is closed.
    """

    __slots__ = (
        "_closed",
        "_complaints",
        "_heard",
        "_key",
        "_longest",
        "_now_ns",
        "_pending",
        "_queryable",
        "_sink",
        "matches",
    )

    def __init__(
        self,
        session: zenoh.Session,
        key: str,
        sink: RequestSink,
        matches: Matches,
        *,
        complaints: Complaints,
        heard: Heard,
        max_message_bytes: int,
        now_ns: Callable[[], int],
        closed: Callable[["ZenohService"], None],
    ) -> None:
        self.matches = matches
        self._key = key
        self._sink = sink
        self._complaints = complaints
        self._heard = heard
        self._longest = max_message_bytes
        self._now_ns = now_ns
        self._closed = closed
        self._pending: dict[RequestId, zenoh.Query] = {}
        self._queryable: Any = session.declare_queryable(
            key,
            zenoh.handlers.Callback(self._on_query, indirect=False),
            complete=True,
            allowed_origin=zenoh.Locality.REMOTE,
        )

    def reply(self, request_id: RequestId, message: Any) -> None:
        query = self._pending.pop(request_id, None)
        if query is None:  # of a client in this process, or answered already
            return
        attachment = Attachment(
            request_id.sequence, self._now_ns(), request_id.client_gid
        )
        with query:
            query.reply(self._key, serialize(message), attachment=attachment.encode())

    def fail(self, request_id: RequestId, reason: str) -> None:
        query = self._pending.pop(request_id, None)
        if query is not None:
            _refuse(query, reason)

    def close(self) -> None:
        if self._queryable is None:
            return
        queryable, self._queryable = self._queryable, None
        self._closed(self)
        queryable.undeclare()
        while self._pending:
            _refuse(self._pending.popitem()[1], "the server was closed")

    # -- on Zenoh's threads ------------------------------------------------------

    def _on_query(self, query: zenoh.Query) -> None:
        try:
            request = self._checked(query)
        except DecodeError as error:
            name = self.matches.endpoint.topic
            text = f"service {name}: request ignored: {error}"
            self._complaints.once(("request", name), text)
            _refuse(query, str(error))
            return
        self._pending[request.id] = query
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
        sequence, source_ns, gid = decode_attachment(attachment.to_bytes())
        request_id = RequestId(gid, sequence)
        if request_id in self._pending:
            raise DecodeError(f"request {sequence} is under way already")
        if len(self._pending) >= _MOST_PENDING:
            raise DecodeError(f"{_MOST_PENDING} requests wait already")
        request_class = _class_of(self.matches.endpoint).Request
        message = deserialize(payload.to_bytes(), request_class)
        return Request(message, source_ns, self._now_ns(), request_id)


class ZenohClient(ClientPort):
    """Asks all remote servers; tells why where none of them answered.

    Args:
        gid: as hashed from the liveliness token.
        timeout_s: so long an answer is waited for. Zenoh keeps 0.8 kB of every request
            until then, also of one that has been answered.
        closed: called once when the port is closed.
    """

    __slots__ = (
        "_closed",
        "_complaints",
        "_gid",
        "_key",
        "_longest",
        "_session",
        "_sink",
        "_timeout_s",
        "matches",
    )

    def __init__(
        self,
        session: zenoh.Session,
        key: str,
        gid: bytes,
        sink: ReplySink,
        matches: Matches,
        *,
        complaints: Complaints,
        max_message_bytes: int,
        timeout_s: float,
        closed: Callable[["ZenohClient"], None],
    ) -> None:
        self.matches = matches
        self._session: zenoh.Session | None = session
        self._key = key
        self._gid = gid
        self._sink = sink
        self._complaints = complaints
        self._longest = max_message_bytes
        self._timeout_s = timeout_s
        self._closed = closed

    def request(self, message: Any, source_ns: int, sequence: int) -> None:
        if self._session is None or not self.matches.remotes:
            return
        attachment = Attachment(sequence, source_ns, self._gid)
        answered = False

        def on_reply(reply: zenoh.Reply) -> None:
            nonlocal answered
            answered = True
            if self._session is not None:
                self._sink(self._reply(reply, sequence))

        def on_end() -> None:
            if not answered and self._session is not None:
                self._sink(Reply(None, sequence, "the server went away"))

        self._session.get(
            self._key,
            zenoh.handlers.Callback(on_reply, on_end, indirect=False),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=self._timeout_s,
            payload=serialize(message),
            attachment=attachment.encode(),
            allowed_destination=zenoh.Locality.REMOTE,
        )

    @property
    def server_count(self) -> int:
        return len(self.matches.remotes)

    def close(self) -> None:
        if self._session is None:
            return
        self._session = None
        self._closed(self)

    # -- on Zenoh's threads ------------------------------------------------------

    def _reply(self, reply: zenoh.Reply, sequence: int) -> Reply:
        if reply.err is not None:
            if reply.err.payload.to_bytes() == _TIMEOUT:
                return Reply(None, sequence, self._time_is_over(), timed_out=True)
            text = reply.err.payload.to_bytes()[:_LONGEST_REASON]
            return Reply(None, sequence, text.decode(errors="replace"))
        try:
            return Reply(self._checked(reply.ok, sequence), sequence)
        except DecodeError as error:
            name = self.matches.endpoint.topic
            text_ = f"service {name}: reply ignored: {error}"
            self._complaints.once(("reply", name), text_)
            return Reply(None, sequence, f"malformed reply: {error}")

    def _time_is_over(self) -> str:
        return f"no answer in {self._timeout_s:g} s (NAVETTE_SERVICE_TIMEOUT)"

    def _checked(self, sample: zenoh.Sample | None, sequence: int) -> Any:
        if sample is None or sample.attachment is None:
            raise DecodeError("without an attachment")
        if len(sample.payload) > self._longest:
            raise DecodeError(
                f"{len(sample.payload)} bytes: longer than {self._longest} "
                "(NAVETTE_MAX_MESSAGE_BYTES)"
            )
        attachment = decode_attachment(sample.attachment.to_bytes())
        if (attachment.sequence, attachment.gid) != (sequence, self._gid):
            raise DecodeError(f"number {attachment.sequence} instead of {sequence}")
        response_class = _class_of(self.matches.endpoint).Response
        return deserialize(sample.payload.to_bytes(), response_class)


def _class_of(endpoint: Endpoint) -> Any:
    return get_interface(endpoint.type_name)


def _refuse(query: zenoh.Query, reason: str) -> None:
    with query:
        query.reply_err(reason.encode()[:_LONGEST_REASON])
