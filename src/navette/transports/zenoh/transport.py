"""The Zenoh transport: endpoints of other processes and machines, rmw_zenoh's way."""

import threading
from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

import zenoh

from navette.errors import NetworkError
from navette.transports.base import (
    Endpoint,
    EndpointKind,
    NodeInfo,
    Sink,
    Transport,
    TransportObserver,
)
from navette.transports.lockstep import Holding, StepTraffic
from navette.transports.qos import EndpointQos, ReliabilityPolicy
from navette.transports.service_ports import ReplySink, RequestSink
from navette.transports.zenoh.clients import ZenohClient
from navette.transports.zenoh.keys import data_key
from navette.transports.zenoh.kin import new_zid
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.own_tokens import OwnTokens
from navette.transports.zenoh.publisher import ZenohPublisher
from navette.transports.zenoh.queryables import Queryables
from navette.transports.zenoh.recovery import Recovery, Retention
from navette.transports.zenoh.services import ZenohService
from navette.transports.zenoh.session import Session
from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.subscription import ZenohSubscription
from navette.transports.zenoh.tokens import EndpointToken, gid_of

_TOPIC_KINDS = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
_SERVICE_KINDS = (EndpointKind.SERVICE, EndpointKind.CLIENT)

Port = ZenohPublisher | ZenohSubscription | ZenohService | ZenohClient
P = TypeVar("P", bound=Port)


class ZenohTransport(Transport):
    """Exchanges samples with other sessions only; safe to use from several threads.

    Endpoints of the same transport do not meet here: the in-process one is beside it.

    Args:
        domain_id: separates systems on one network.
        now_ns: the time here, for received stamps and replies.
        traffic: in lock-step with other processes: holds and counts the samples.

    Raises:
        NetworkError: the network cannot be joined.
        InvalidValueError: the environment says something that cannot be.
    """

    def __init__(
        self,
        domain_id: int,
        now_ns: Callable[[], int],
        settings: Settings | None = None,
        *,
        traffic: StepTraffic | None = None,
    ) -> None:
        self.domain_id = domain_id
        self._now_ns = now_ns
        self._traffic = traffic
        # In lock-step there is no recovery, and nobody is to wait for its letters.
        zid = new_zid() if traffic is None else ""
        self.session = Session(settings or Settings.from_environment(), domain_id, zid)
        self._graph = self.session.graph
        # In lock-step nothing is lost, and every sample is counted.
        self._recovery = None if traffic is not None else self._make_recovery()
        # There each publisher is counted from its first sample on.
        reuses = traffic is None
        self._tokens = OwnTokens(self.session, domain_id, reuses_endpoints=reuses)
        self._queryables = Queryables(
            self.session.zenoh, shares=not self.session.settings.has_rules
        )
        self._ports: dict[Port, tuple[EndpointToken, zenoh.LivelinessToken]] = {}
        #: Gids of the publishers here: those they reach in process are not told twice.
        self._own_gids: set[bytes] = set()
        self._lock = threading.Lock()

    def observe(self, observer: TransportObserver) -> None:
        self._graph.observers.append(observer)

    # -- nodes -----------------------------------------------------------------

    def announce(self, node: NodeInfo) -> None:
        self._tokens.announce(node)

    def withdraw(self, node: NodeInfo) -> None:
        self._tokens.withdraw(node)

    def remote_nodes(self) -> list[NodeInfo]:
        return self._graph.nodes()

    # -- endpoints -------------------------------------------------------------

    def gid_for(self, endpoint: Endpoint) -> bytes:
        return self._tokens.gid_for(endpoint)

    def advertise(self, endpoint: Endpoint, message_class: type) -> ZenohPublisher:
        def make(token: EndpointToken, used: int, matches: Matches) -> ZenohPublisher:
            gid = gid_of(token.key())
            self._own_gids.add(gid)
            key, session, sent = self._key(token), self.session.zenoh, None
            if self._traffic is not None:
                sent = self._traffic.tally.open(gid, endpoint.node_full_name)
            return ZenohPublisher(
                session,
                key,
                token.qos,
                gid,
                matches,
                used,
                self.session.heard,
                self._retention(gid, key, token.qos, used, matches),
                self._assert_alive,
                self._leave,
                sent,
            )

        return self._open(endpoint, make)

    def subscribe(
        self, endpoint: Endpoint, message_class: type, sink: Sink, *, shared: bool
    ) -> ZenohSubscription:
        def make(token: EndpointToken, _: int, matches: Matches) -> ZenohSubscription:
            recovery = self._recovery_of(token.qos)
            if recovery is not None:
                recovery.open()  # letters come as soon as others know of it
            port = ZenohSubscription(
                self.session.zenoh,
                self._key(token),
                message_class,
                sink,
                matches,
                wants=None if recovery is None else recovery.wants,
                own_gids=self._own_gids,
                lost=partial(self._graph.lost, endpoint),
                now_ns=self._now_ns,
                heard=self.session.heard,
                holding=self._holding(endpoint, sink, matches),
                **self._common(),
            )
            if recovery is not None:
                recovery.hearing.add(gid_of(token.key()), port.arrivals)
            return port

        return self._open(endpoint, make)

    def serve(self, endpoint: Endpoint, sink: RequestSink) -> ZenohService:
        def make(token: EndpointToken, _: int, matches: Matches) -> ZenohService:
            return ZenohService(
                partial(self._queryables.open, is_of_node=_is_of_node(endpoint)),
                self._key(token),
                sink,
                matches,
                heard=self.session.heard,
                now_ns=self._now_ns,
                **self._common(),
            )

        return self._open(endpoint, make)

    def connect(self, endpoint: Endpoint, sink: ReplySink) -> ZenohClient:
        def make(token: EndpointToken, used: int, matches: Matches) -> ZenohClient:
            return ZenohClient(
                self.session.zenoh,
                self._key(token),
                gid_of(token.key()),
                sink,
                matches,
                used=used,
                timeout_s=self.session.settings.service_timeout_s,
                **self._common(),
            )

        return self._open(endpoint, make)

    def endpoints(self) -> list[Endpoint]:
        """Those of other sessions."""
        return self._graph.endpoints(_TOPIC_KINDS)

    def service_endpoints(self) -> list[Endpoint]:
        """Those of other sessions."""
        return self._graph.endpoints(_SERVICE_KINDS)

    def close(self) -> None:
        with self._lock:
            ports = list(self._ports)
        if self._recovery is not None:
            self._recovery.farewell()
        for port in ports:
            port.close()
        self.session.close()
        if self._recovery is not None:
            self._recovery.join()

    # -- for a lock-step -------------------------------------------------------

    def own_nodes(self) -> tuple[str, ...]:
        """Full names of the nodes announced here."""
        return tuple(dict.fromkeys(node.full_name for node in self._tokens.nodes()))

    def own_count(self) -> int:
        """How many nodes and endpoints are announced here."""
        with self._lock:
            return len(self._tokens.nodes()) + len(self._ports)

    def _holding(
        self, endpoint: Endpoint, sink: Sink, matches: Matches
    ) -> Holding | None:
        if self._traffic is None:
            return None
        return self._traffic.held.open(
            endpoint.topic,
            sink,
            lambda: dict(matches.by_gid),
            is_latched=endpoint.qos.is_latched,
            depth=endpoint.qos.queue_length,
            heard=matches.heard,
        )

    # -- what is lost on the way -------------------------------------------------

    def _make_recovery(self) -> Recovery:
        session = self.session
        recovery = Recovery(
            session.zenoh,
            session.zid,
            self.domain_id,
            session.complaints,
            session.settings.max_message_bytes,
            self._graph.asserted_by,
        )
        self._graph.observers.append(recovery)
        return recovery

    def _recovery_of(self, qos: EndpointQos) -> Recovery | None:
        """None where an endpoint takes what comes."""
        is_reliable = qos.reliability == ReliabilityPolicy.RELIABLE
        return self._recovery if is_reliable else None

    def _retention(
        self, gid: bytes, key: str, qos: EndpointQos, used: int, matches: Matches
    ) -> Retention | None:
        recovery = self._recovery_of(qos)
        if recovery is None:
            return None
        retention = Retention(qos.queue_length, used)
        recovery.offers.add(gid, key, matches, retention)
        return retention

    def _assert_alive(self, matches: Matches) -> bool:
        if self._recovery is None:
            return not matches.remotes
        return self._recovery.assert_alive(matches)

    # -- inside ----------------------------------------------------------------

    def _key(self, token: EndpointToken) -> str:
        return data_key(token.domain_id, token.topic, token.type_name, token.type_hash)

    def _open(
        self, endpoint: Endpoint, make: Callable[[EndpointToken, int, Matches], P]
    ) -> P:
        """A port that is matched, then announced: who sees its token may rely on it."""
        token, used = self._tokens.take(endpoint)
        matches = self._graph.add_local(endpoint, token.type_hash)
        try:
            port = make(token, used, matches)
            declared = self._tokens.declare(token)
        except zenoh.ZError as error:
            if self._recovery is not None:
                self._recovery.leave(matches)
            self._graph.remove_local(matches)
            raise NetworkError(
                f"{endpoint.kind.name.lower()} of {endpoint.topic} (node "
                f"{endpoint.node_full_name}) cannot be opened: {error}"
            ) from error
        with self._lock:
            self._ports[port] = token, declared
        return port

    def _common(self) -> dict[str, Any]:
        return {
            "complaints": self.session.complaints,
            "max_message_bytes": self.session.settings.max_message_bytes,
            "closed": self._leave,
        }

    def _leave(self, port: Port) -> None:
        with self._lock:
            token, declared = self._ports.pop(port)
        self._own_gids.discard(port.matches.endpoint.gid)
        if self._recovery is not None:
            self._recovery.leave(port.matches)
        self._graph.remove_local(port.matches)
        self._tokens.take_back(token, declared, port.last)


def _is_of_node(endpoint: Endpoint) -> bool:
    """Whether its name is that of its node and one word more."""
    return endpoint.topic.rpartition("/")[0] == endpoint.node_full_name
