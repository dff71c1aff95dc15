"""Services that clients may call, and their calls."""

import itertools
from collections.abc import Iterable, Mapping
from functools import partial

from navette.viewer import frames, replies
from navette.viewer.replies import OfferedService
from navette.viewer.session import CallId, ProgramCommands, Session

_MAX_CALLS = 32  # of a client, without a response


class OfferedServices:
    """The services of the graph, each with an id by which clients call it.

    Args:
        sessions: the connected clients by id.
    """

    def __init__(
        self, program: ProgramCommands, sessions: Mapping[int, Session]
    ) -> None:
        self._program = program
        self._sessions = sessions
        self._by_id: dict[int, OfferedService] = {}
        self._ids = itertools.count(1)
        #: Encoded once for any number of clients that join; empty without services.
        self.advertisement = ""

    def set_services(self, services: Iterable[OfferedService]) -> None:
        """Replace the services; send the difference to all clients."""
        wanted = dict.fromkeys(services)
        gone = [key for key, service in self._by_id.items() if service not in wanted]
        for key in gone:
            del self._by_id[key]
        known = set(self._by_id.values())
        added = {next(self._ids): each for each in wanted if each not in known}
        self._by_id |= added
        if gone:
            self._broadcast(replies.unadvertise_services(gone))
        if added:
            self._broadcast(replies.advertise_services(added.items()))
        if gone or added:
            self.advertisement = replies.advertise_services(self._by_id.items())

    def call(self, session: Session, request: frames.CallService) -> None:
        call_id = CallId(session.id, request.service_id, request.call_id)
        service = self._by_id.get(request.service_id)
        problem = ""
        if service is None:
            problem = f"unknown service id {request.service_id}"
        elif request.encoding not in replies.ENCODINGS:
            known = ", ".join(replies.ENCODINGS)
            problem = f"encoding {request.encoding!r:.80}; known: {known}"
        elif call_id in session.calls:
            problem = f"call id {request.call_id} is in use"
        elif len(session.calls) >= _MAX_CALLS:
            problem = f"{_MAX_CALLS} calls have no response yet"
        if service is None or problem:
            session.send(
                replies.service_failure(request.service_id, request.call_id, problem)
            )
            return
        session.calls.add(call_id)
        command = self._program.call_service
        session.commands.add(
            session.id,
            partial(command, call_id, service, request.encoding, request.data),
        )

    def responded(self, call_id: CallId, encoding: str, data: bytes) -> None:
        number, service_id = call_id.number, call_id.service_id
        frame = replies.service_response(service_id, number, encoding, data)
        self._end_call(call_id, frame)

    def failed(self, call_id: CallId, reason: str) -> None:
        number, service_id = call_id.number, call_id.service_id
        self._end_call(call_id, replies.service_failure(service_id, number, reason))

    def _end_call(self, call_id: CallId, frame: str | bytes) -> None:
        session = self._sessions.get(call_id.client)
        if session is not None:
            session.calls.discard(call_id)
            session.send(frame)

    def _broadcast(self, frame: str | bytes) -> None:
        for session in self._sessions.values():
            session.send(frame)
