"""Reports and grants of a lock-step over Zenoh, on keys beside those of rmw_zenoh."""

from collections.abc import Callable
from typing import Any, TypeVar

import zenoh

from navette.errors import DecodeError
from navette.transports.lockstep import (
    MAX_BYTES,
    Participants,
    StepGrant,
    StepReport,
    StepWire,
    parse_grant,
    parse_report,
)
from navette.transports.zenoh.callbacks import direct
from navette.transports.zenoh.transport import ZenohTransport

SPACE = "navette_lockstep"

T = TypeVar("T", StepReport, StepGrant)


class ZenohStepWire(StepWire):
    """Publishes reports on ``<domain>/navette_lockstep/report/<session>`` and grants on
    ``<domain>/navette_lockstep/grant/<session>``.

    Create it before the process announces its first node: other processes send as soon
    as they see that node. It ends with the transport's session.
    """

    def __init__(self, transport: ZenohTransport) -> None:
        self._transport = transport
        self._space = f"{transport.domain_id}/{SPACE}"
        self._subscribers: list[Any] = []
        self._report = self._publisher("report")
        self._grant = self._publisher("grant")

    @property
    def session(self) -> str:
        return self._transport.session.zid

    def participants(self) -> Participants:
        seen = self._transport.session.graph.counts()
        return Participants(
            nodes=self._transport.own_nodes(),
            others=tuple(n.full_name for n in self._transport.remote_nodes()),
            own=self._transport.own_count(),
            seen=seen,
        )

    def send_report(self, report: StepReport) -> None:
        self._report.put(report.encode())

    def send_grant(self, grant: StepGrant) -> None:
        self._grant.put(grant.encode())

    def subscribe_reports(self, callback: Callable[[str, StepReport], None]) -> None:
        self._subscribe("report", parse_report, callback)

    def subscribe_grants(self, callback: Callable[[StepGrant], None]) -> None:
        def from_coordinator(session: str, grant: StepGrant) -> None:
            if grant.coordinator == session:
                callback(grant)

        self._subscribe("grant", parse_grant, from_coordinator)

    def _publisher(self, kind: str) -> Any:
        return self._transport.session.zenoh.declare_publisher(
            f"{self._space}/{kind}/{self.session}",
            reliability=zenoh.Reliability.RELIABLE,
            congestion_control=zenoh.CongestionControl.BLOCK,
            express=True,  # every process waits for it
        )

    def _subscribe(
        self,
        kind: str,
        parse: Callable[[bytes], T],
        callback: Callable[[str, T], None],
    ) -> None:
        def on_sample(sample: zenoh.Sample) -> None:
            session = str(sample.key_expr).rpartition("/")[2]
            payload = sample.payload
            try:
                if len(payload) > MAX_BYTES:
                    raise DecodeError(f"{len(payload)} bytes: longer than {MAX_BYTES}")
                record = parse(payload.to_bytes())
            except DecodeError as error:
                self._transport.session.log_once.warning(
                    ("lockstep", kind, session),
                    f"lock-step: {kind} of session {session} ignored: {error}",
                )
                return
            callback(session, record)

        self._subscribers.append(
            self._transport.session.zenoh.declare_subscriber(
                f"{self._space}/{kind}/*",
                direct(on_sample),
                allowed_origin=zenoh.Locality.REMOTE,
            )
        )
