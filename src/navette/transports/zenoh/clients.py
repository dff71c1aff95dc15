"""Clients of services: each request is a query to all remote servers."""

from enum import IntEnum
from typing import Any

import zenoh

from navette.errors import DecodeError
from navette.msgs import deserialize, get_interface, serialize
from navette.transports.service_ports import ClientPort, Reply, ReplySink
from navette.transports.zenoh.attachment import (
    Attachment,
    check_length,
    decode_attachment,
)
from navette.transports.zenoh.callbacks import direct
from navette.transports.zenoh.ports import PortOwner, ZenohEntity

_MAX_REASON_BYTES = 2000
# Replies of unlisted sessions that are examined for one request.
_MAX_UNLISTED = 20
# Zenoh's error payload when the query timeout is over.
_TIMEOUT = b"Timeout"


class ZenohClient(ClientPort):
    """Sends requests to all remote servers; reports why a request failed.

    Zenoh keeps 0.8 kB of every request until the service timeout, also after the reply
    (decision 0018).
    """

    def __init__(
        self, owner: PortOwner, entity: ZenohEntity, *, sink: ReplySink
    ) -> None:
        self.matches = entity.matches
        #: Newest sequence number, also of requests that had no remote server.
        self.last = entity.initial_sequence
        self._owner = owner
        self._entity = entity
        self._sink = sink
        self._is_open = True

    def request(self, message: Any, source_ns: int, sequence: int) -> None:
        self.last = sequence
        if not (self._is_open and self.matches.remotes):
            return
        attachment = Attachment(sequence, source_ns, self._entity.gid)
        call = _Call(self, sequence)
        self._owner.session.zenoh.get(
            self._entity.key,
            direct(call.on_reply, call.on_end),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=self._owner.session.settings.service_timeout_s,
            payload=serialize(message),
            attachment=attachment.encode(),
            allowed_destination=zenoh.Locality.REMOTE,
        )

    @property
    def initial_sequence(self) -> int:
        return self._entity.initial_sequence

    @property
    def server_count(self) -> int:
        return len(self.matches.remotes)

    def close(self) -> None:
        if not self._is_open:
            return
        self._is_open = False
        self._owner.release(self)

    # The following methods run on Zenoh's threads.

    def deliver(self, reply: Reply) -> None:
        """Pass the outcome of a call on, unless the port was closed."""
        if self._is_open:
            self._sink(reply)

    def ranked(self, reply: zenoh.Reply, sequence: int) -> tuple["_Rank", Reply]:
        """Return the reply to a request with its rank among others."""
        if reply.err is not None:
            return _Rank.FAILURE, self._failed(reply.err, sequence)
        try:
            message = self._decoded(reply.ok, sequence)
        except DecodeError as error:
            name = self.matches.endpoint.topic
            text = f"service {name}: reply ignored: {error}"
            self._owner.session.log_once.warning(("reply", name, str(error)), text)
            failed = Reply(None, sequence, f"malformed reply: {error}")
            return _Rank.MALFORMED, failed
        rank = _Rank.LISTED if self.is_listed(reply) else _Rank.UNLISTED
        return rank, Reply(message, sequence)

    def is_listed(self, reply: zenoh.Reply) -> bool:
        """Return whether the graph lists a server of the replying session."""
        if reply.replier_id is None:
            return False
        return str(reply.replier_id.zid) in tuple(self.matches.sessions.values())

    def _failed(self, error: zenoh.ReplyError, sequence: int) -> Reply:
        text = error.payload.to_bytes()[:_MAX_REASON_BYTES]
        if text != _TIMEOUT:
            return Reply(None, sequence, text.decode(errors="replace"))
        timeout_s = self._owner.session.settings.service_timeout_s
        reason = f"no reply within {timeout_s:g} s (NAVETTE_SERVICE_TIMEOUT)"
        return Reply(None, sequence, reason, timed_out=True)

    def _decoded(self, sample: zenoh.Sample | None, sequence: int) -> Any:
        if sample is None or sample.attachment is None:
            raise DecodeError("without an attachment")
        check_length(sample.payload, self._owner.session.settings.max_message_bytes)
        # Not the gid: the query itself leads the reply here, and servers on Pico-ROS
        # send their own gid, which rmw_zenoh accepts.
        attachment = decode_attachment(sample.attachment.to_bytes())
        if attachment.sequence != sequence:
            raise DecodeError(
                f"sequence number {attachment.sequence} instead of {sequence}"
            )
        interface: Any = get_interface(self.matches.endpoint.type_name)
        return deserialize(sample.payload.to_bytes(), interface.Response)


class _Rank(IntEnum):
    """Rank of a reply; the first reply of the highest rank is delivered."""

    NONE = 0
    MALFORMED = 1
    FAILURE = 2
    UNLISTED = 3
    LISTED = 4


class _Call:
    """One request in progress.

    The reply of a server in the graph is delivered at once. Any other reply may come
    from a program that pretends to serve, or from a broken one: the best of them is
    delivered when all servers have replied.
    """

    __slots__ = ("_best", "_client", "_count", "_rank", "_sequence")

    def __init__(self, client: ZenohClient, sequence: int) -> None:
        self._client = client
        self._sequence = sequence
        self._rank = _Rank.NONE
        self._count = 0
        self._best = Reply(None, sequence, "the server closed")

    def on_reply(self, reply: zenoh.Reply) -> None:
        """Take a reply, an error or the timeout from Zenoh."""
        if self._rank == _Rank.LISTED:
            return
        self._count += 1
        if self._count > _MAX_UNLISTED and not self._client.is_listed(reply):
            return
        rank, found = self._client.ranked(reply, self._sequence)
        if rank > self._rank:
            self._rank, self._best = rank, found
        if rank == _Rank.LISTED:
            self._client.deliver(found)

    def on_end(self) -> None:
        """Deliver the best reply: all servers have replied or closed."""
        if self._rank != _Rank.LISTED:
            self._client.deliver(self._best)
