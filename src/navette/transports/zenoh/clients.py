"""Clients of services: a query for every request, to all servers that there are."""

from collections.abc import Callable
from enum import IntEnum
from typing import Any

import zenoh

from navette.errors import DecodeError
from navette.msgs import deserialize, get_interface, serialize
from navette.transports.service_ports import ClientPort, Reply, ReplySink
from navette.transports.zenoh.attachment import Attachment, decode_attachment
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.matches import Matches

_LONGEST_REASON = 2000
# What is looked at for one request of those that the graph does not list.
_MOST_OF_STRANGERS = 20
# What Zenoh tells in place of a reply when the time is over.
_TIMEOUT = b"Timeout"


class ZenohClient(ClientPort):
    """Asks all remote servers; tells why where none of them answered.

    Args:
        gid: as hashed from the liveliness token.
        used: the last number that was sent under that gid before.
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
        "_used",
        "last",
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
        used: int,
        closed: Callable[["ZenohClient"], None],
    ) -> None:
        self.matches = matches
        #: The newest number, also of a request that nobody remote gets.
        self.last = self._used = used
        self._session: zenoh.Session | None = session
        self._key = key
        self._gid = gid
        self._sink = sink
        self._complaints = complaints
        self._longest = max_message_bytes
        self._timeout_s = timeout_s
        self._closed = closed

    def request(self, message: Any, source_ns: int, sequence: int) -> None:
        self.last = sequence
        session = self._session  # another thread may close it meanwhile
        if session is None or not self.matches.remotes:
            return
        attachment = Attachment(sequence, source_ns, self._gid)
        call = _Call(self, sequence)
        session.get(
            self._key,
            zenoh.handlers.Callback(call.on_reply, call.on_end, indirect=False),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=self._timeout_s,
            payload=serialize(message),
            attachment=attachment.encode(),
            allowed_destination=zenoh.Locality.REMOTE,
        )

    @property
    def used(self) -> int:
        return self._used

    @property
    def server_count(self) -> int:
        return len(self.matches.remotes)

    def close(self) -> None:
        if self._session is None:
            return
        self._session = None
        self._closed(self)

    # -- on Zenoh's threads ------------------------------------------------------

    def give(self, reply: Reply) -> None:
        """Hand the outcome of a call on, unless the port was closed."""
        if self._session is not None:
            self._sink(reply)

    def judged(self, reply: zenoh.Reply, sequence: int) -> tuple["_Worth", Reply]:
        """What came for a request, and how much it is worth."""
        if reply.err is not None:
            return _Worth.REASON, self._failed(reply.err, sequence)
        try:
            message = self._checked(reply.ok, sequence)
        except DecodeError as error:
            name = self.matches.endpoint.topic
            text = f"service {name}: reply ignored: {error}"
            self._complaints.once(("reply", name, str(error)), text)
            return _Worth.MALFORMED, Reply(None, sequence, f"malformed reply: {error}")
        worth = _Worth.ANSWER if self.is_listed(reply) else _Worth.STRANGERS_ANSWER
        return worth, Reply(message, sequence)

    def is_listed(self, reply: zenoh.Reply) -> bool:
        """Whether the graph has a server of that session."""
        if reply.replier_id is None:
            return False
        return str(reply.replier_id.zid) in tuple(self.matches.sessions.values())

    def _failed(self, error: zenoh.ReplyError, sequence: int) -> Reply:
        text = error.payload.to_bytes()[:_LONGEST_REASON]
        if text != _TIMEOUT:
            return Reply(None, sequence, text.decode(errors="replace"))
        reason = f"no answer in {self._timeout_s:g} s (NAVETTE_SERVICE_TIMEOUT)"
        return Reply(None, sequence, reason, timed_out=True)

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
        interface: Any = get_interface(self.matches.endpoint.type_name)
        return deserialize(sample.payload.to_bytes(), interface.Response)


class _Worth(IntEnum):
    """Of what comes for a request; the first of the highest worth counts."""

    NOTHING = 0
    MALFORMED = 1
    REASON = 2
    STRANGERS_ANSWER = 3
    ANSWER = 4


class _Call:
    """One request under way.

    The answer of a server that the graph lists counts at once. Anything else may be of
    somebody who only pretends to serve, or is broken: it counts when all have spoken.
    """

    __slots__ = ("_client", "_count", "_found", "_sequence", "_worth")

    def __init__(self, client: ZenohClient, sequence: int) -> None:
        self._client = client
        self._sequence = sequence
        self._worth = _Worth.NOTHING
        self._count = 0
        self._found = Reply(None, sequence, "the server went away")

    def on_reply(self, reply: zenoh.Reply) -> None:
        """Zenoh has a reply, an error, or the end of the time."""
        if self._worth == _Worth.ANSWER:
            return
        self._count += 1
        if self._count > _MOST_OF_STRANGERS and not self._client.is_listed(reply):
            return
        worth, found = self._client.judged(reply, self._sequence)
        if worth > self._worth:
            self._worth, self._found = worth, found
        if worth == _Worth.ANSWER:
            self._client.give(found)

    def on_end(self) -> None:
        """All have spoken, or are gone."""
        if self._worth != _Worth.ANSWER:
            self._client.give(self._found)
