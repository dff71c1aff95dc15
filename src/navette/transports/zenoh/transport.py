"""The Zenoh transport: endpoints of other processes and machines, as in rmw_zenoh."""

import threading
from collections.abc import Callable
from typing import TypeVar

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
from navette.transports.clock import NanosecondClock
from navette.transports.lockstep import (
    BufferedSubscription,
    StepTraffic,
    SubscriptionInfo,
)
from navette.transports.service_ports import ReplySink, RequestSink
from navette.transports.zenoh.assertions import LivelinessAssertions
from navette.transports.zenoh.clients import ZenohClient
from navette.transports.zenoh.keys import data_key
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.own_tokens import OwnTokens
from navette.transports.zenoh.ports import ZenohEntity
from navette.transports.zenoh.publisher import ZenohPublisher
from navette.transports.zenoh.queryables import Queryables
from navette.transports.zenoh.retransmission import retransmits
from navette.transports.zenoh.services import ZenohService
from navette.transports.zenoh.session import ZenohSession
from navette.transports.zenoh.settings import Settings
from navette.transports.zenoh.subscription import ZenohSubscription
from navette.transports.zenoh.tokens import EndpointToken, gid_of

_TOPIC_KINDS = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
_SERVICE_KINDS = (EndpointKind.SERVICE, EndpointKind.CLIENT)

Port = ZenohPublisher | ZenohSubscription | ZenohService | ZenohClient
P = TypeVar("P", bound=Port)


class ZenohTransport(Transport):
    """Exchanges samples with other sessions only; safe to use from several threads.

    Endpoints of the same transport do not meet here: the in-process transport connects
    them.

    Args:
        domain_id: separates systems on one network.
        clock: the time for received stamps and replies.
        settings: default: from the environment.
        traffic: in lock-step with other processes: buffers and counts the samples.

    Raises:
        NetworkError: the network cannot be joined.
        InvalidValueError: an environment variable has an invalid value.
    """

    def __init__(
        self,
        domain_id: int,
        clock: NanosecondClock,
        settings: Settings | None = None,
        *,
        traffic: StepTraffic | None = None,
    ) -> None:
        self.domain_id = domain_id
        self.clock = clock
        self._traffic = traffic
        self.session = ZenohSession(settings or Settings.from_environment(), domain_id)
        self._graph = self.session.graph
        self._assertions = LivelinessAssertions(
            self.session.zenoh, domain_id, self._graph
        )
        self._graph.observers += (self._assertions, self.session.shared_pools)
        # In lock-step each publisher is counted from its first sample on, so that it
        # cannot continue the numbers of an earlier one.
        self._tokens = OwnTokens(
            self.session, domain_id, reuses_endpoints=traffic is None
        )
        self._queryables = Queryables(
            self.session.zenoh, shares=not self.session.settings.has_rules
        )
        self._ports: dict[Port, tuple[EndpointToken, zenoh.LivelinessToken]] = {}
        self.own_gids: set[bytes] = set()
        self._lock = threading.Lock()

    def observe(self, observer: TransportObserver) -> None:
        self._graph.observers.append(observer)

    def announce(self, node: NodeInfo) -> None:
        self._tokens.announce(node)

    def withdraw(self, node: NodeInfo) -> None:
        self._tokens.withdraw(node)

    def remote_nodes(self) -> list[NodeInfo]:
        return self._graph.nodes()

    def gid_for(self, endpoint: Endpoint) -> bytes:
        return self._tokens.gid_for(endpoint)

    def advertise(self, endpoint: Endpoint, message_class: type) -> ZenohPublisher:
        def make(entity: ZenohEntity) -> ZenohPublisher:
            self.own_gids.add(entity.gid)
            sent_count = None
            if self._traffic is not None:
                sent_count = self._traffic.sent_counter.open(
                    entity.gid, endpoint.node_full_name
                )
            return ZenohPublisher(
                self,
                entity,
                retransmits=self._retransmits(entity),
                sent_count=sent_count,
            )

        return self._open(endpoint, make)

    def subscribe(
        self, endpoint: Endpoint, message_class: type, sink: Sink, *, shared: bool
    ) -> ZenohSubscription:
        def make(entity: ZenohEntity) -> ZenohSubscription:
            if endpoint.qos.asserts_itself:
                # Before the token: a publisher may assert itself once it sees that.
                self._assertions.receive()
            return ZenohSubscription(
                self,
                entity,
                message_class,
                sink=sink,
                retransmits=self._retransmits(entity),
                buffered=self._buffered(endpoint, sink, entity.matches),
            )

        return self._open(endpoint, make)

    def serve(self, endpoint: Endpoint, sink: RequestSink) -> ZenohService:
        return self._open(
            endpoint,
            lambda entity: ZenohService(self, entity, self._queryables, sink=sink),
        )

    def connect(self, endpoint: Endpoint, sink: ReplySink) -> ZenohClient:
        return self._open(endpoint, lambda entity: ZenohClient(self, entity, sink=sink))

    def endpoints(self, topic: str | None = None) -> list[Endpoint]:
        return self._graph.endpoints(_TOPIC_KINDS, topic)

    def service_endpoints(self) -> list[Endpoint]:
        return self._graph.endpoints(_SERVICE_KINDS)

    def close(self) -> None:
        with self._lock:
            ports = list(self._ports)
        for port in ports:
            port.close()
        self.session.close()

    def release(self, port: Port) -> None:
        """Withdraw the endpoint of a port that closes."""
        with self._lock:
            token, declared = self._ports.pop(port)
        self.own_gids.discard(port.matches.endpoint.gid)
        self._graph.remove_local(port.matches)
        self._tokens.take_back(token, declared, port.last)

    def assert_liveliness(self, matches: Matches) -> bool:
        """Announce that a publisher is alive; see ``PublisherPort.assert_alive``."""
        return self._assertions.send(matches)

    def own_nodes(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(node.full_name for node in self._tokens.nodes()))

    def own_count(self) -> int:
        with self._lock:
            return len(self._tokens.nodes()) + len(self._ports)

    def _buffered(
        self, endpoint: Endpoint, sink: Sink, matches: Matches
    ) -> BufferedSubscription | None:
        if self._traffic is None:
            return None
        info = SubscriptionInfo(
            endpoint.topic,
            matches,
            sink=sink,
            is_latched=endpoint.qos.is_latched,
            depth=endpoint.qos.queue_length,
        )
        return self._traffic.buffer.open(info)

    def _retransmits(self, entity: ZenohEntity) -> bool:
        if self._traffic is not None:  # publishers block there: no sample is lost
            return False
        topic = entity.matches.endpoint.topic
        return retransmits(entity.qos, topic, self.session.settings.retransmit)

    def _open(self, endpoint: Endpoint, make: Callable[[ZenohEntity], P]) -> P:
        """Make a matched port, then announce it: its token means that it is ready."""
        token, initial_sequence = self._tokens.take(endpoint)
        matches = self._graph.add_local(endpoint, token.type_hash)
        entity = ZenohEntity(
            matches,
            data_key(token.domain_id, token.topic, token.type_name, token.type_hash),
            gid_of(token.key()),
            token.qos,
            initial_sequence,
        )
        try:
            port = make(entity)
            declared = self._tokens.declare(token)
        except zenoh.ZError as error:
            self._graph.remove_local(matches)
            raise NetworkError(
                f"{endpoint.kind.name.lower()} of {endpoint.topic} (node "
                f"{endpoint.node_full_name}) cannot be opened: {error}"
            ) from error
        with self._lock:
            self._ports[port] = token, declared
        return port
