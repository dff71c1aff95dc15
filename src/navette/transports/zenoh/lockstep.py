"""Reports and grants of a lock-step, under keys of their own beside rmw_zenoh's."""

from collections.abc import Callable
from typing import Any, TypeVar

import zenoh

from navette.errors import DecodeError
from navette.transports.lockstep import (
    MOST_BYTES,
    Census,
    Grant,
    Report,
    StepWire,
    parse_grant,
    parse_report,
)
from navette.transports.zenoh.transport import ZenohTransport

SPACE = "navette_lockstep"

T = TypeVar("T", Report, Grant)


class ZenohStepWire(StepWire):
    """Reports go to ``<domain>/navette_lockstep/report/<session>``, grants to
    ``<domain>/navette_lockstep/grant/<session>``.

    To be made before the process announces its first node: who sees that can rely on
    being heard. It ends with the transport's session.
    """

    def __init__(self, transport: ZenohTransport) -> None:
        self._transport = transport
        self._space = f"{transport.domain_id}/{SPACE}"
        self._log_once = transport.session.log_once
        self._listening: list[Any] = []
        self._report = self._publisher("report")
        self._grant = self._publisher("grant")

    @property
    def session(self) -> str:
        return self._transport.session.zid

    def census(self) -> Census:
        seen = self._transport.session.graph.counts()
        return Census(
            nodes=self._transport.own_nodes(),
            others=tuple(n.full_name for n in self._transport.remote_nodes()),
            own=self._transport.own_count(),
            seen=seen,
        )

    def report(self, report: Report) -> None:
        self._report.put(report.encode())

    def grant(self, grant: Grant) -> None:
        self._grant.put(grant.encode())

    def hear_reports(self, callback: Callable[[str, Report], None]) -> None:
        self._hear("report", parse_report, callback)

    def hear_grants(self, callback: Callable[[Grant], None]) -> None:
        def from_conductor(session: str, grant: Grant) -> None:
            if grant.conductor == session:
                callback(grant)

        self._hear("grant", parse_grant, from_conductor)

    def _publisher(self, kind: str) -> Any:
        return self._transport.session.zenoh.declare_publisher(
            f"{self._space}/{kind}/{self.session}",
            reliability=zenoh.Reliability.RELIABLE,
            congestion_control=zenoh.CongestionControl.BLOCK,
            express=True,  # all wait for it
        )

    def _hear(
        self,
        kind: str,
        parse: Callable[[bytes], T],
        callback: Callable[[str, T], None],
    ) -> None:
        def on_sample(sample: zenoh.Sample) -> None:
            session = str(sample.key_expr).rpartition("/")[2]
            payload = sample.payload
            try:
                if len(payload) > MOST_BYTES:
                    raise DecodeError(f"{len(payload)} bytes: too long")
                record = parse(payload.to_bytes())
            except DecodeError as error:
                text = f"lock-step: {kind} of session {session} ignored: {error}"
                self._log_once.warning(("lockstep", kind, session), text)
                return
            callback(session, record)

        self._listening.append(
            self._transport.session.zenoh.declare_subscriber(
                f"{self._space}/{kind}/*",
                zenoh.handlers.Callback(on_sample, indirect=False),
                allowed_origin=zenoh.Locality.REMOTE,
            )
        )
