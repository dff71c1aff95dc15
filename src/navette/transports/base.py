"""The seam: a transport moves (topic, message) between endpoints; it knows no node.

The runtime opens a port per publisher and per subscription on every transport of
its context, and one per server and client of a service. A transport that serialises
does so inside its own ports, and only while someone remote listens. Actions are
services and topics put together: the seam does not know them.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

from navette.transports.qos import EndpointQos, QoSPolicyKind
from navette.transports.service_ports import (
    ClientPort,
    ReplySink,
    RequestSink,
    ServicePort,
)

Item = tuple[Any, int, int, int]
"""One delivered sample: message, source stamp (ns), received stamp (ns), sequence.

A message that came as bytes is an :class:`~navette.transports.encoded.Encoded`, one of
a publisher with a lifespan an :class:`~navette.transports.expiring.Expiring`.
"""

Sink = Callable[[Item], None]
"""Takes one delivered sample; must only queue it and return."""


@dataclass(frozen=True)
class NodeInfo:
    """A node as the graph lists it."""

    name: str
    namespace: str
    enclave: str = "/"

    @property
    def full_name(self) -> str:
        return f"{self.namespace.rstrip('/')}/{self.name}"


class EndpointKind(Enum):
    """What an endpoint does on its topic or service."""

    PUBLISHER = 1
    SUBSCRIPTION = 2
    SERVICE = 3
    CLIENT = 4

    # Each is one object; Enum's own hashes the name, in Python, at every look-up.
    __hash__ = object.__hash__


@dataclass(frozen=True, slots=True)
class Endpoint:
    """One end of a topic or service, as the graph lists it (labels, no node object).

    ``topic`` is the name of the service for servers and clients. ``type_hash`` is that
    of a remote endpoint, as it was announced; empty = the one of the type here.
    """

    kind: EndpointKind
    topic: str
    type_name: str
    qos: EndpointQos
    node_name: str
    node_namespace: str
    gid: bytes
    type_hash: str = ""

    @property
    def is_remote(self) -> bool:
        """Whether it is of another process."""
        return bool(self.type_hash)

    @property
    def node_full_name(self) -> str:
        return f"{self.node_namespace.rstrip('/')}/{self.node_name}"


class TransportObserver:
    """What a transport tells its owner; override what is of interest."""

    def graph_changed(self) -> None:
        """An endpoint or a node came or went."""

    def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        """The two endpoints exchange samples from now on."""

    def unmatched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        """The two endpoints no longer exchange samples."""

    def asserted(self, publisher: Endpoint, subscription: Endpoint) -> None:
        """A sample of a remote publisher that asserts itself has come."""

    def incompatible_qos(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> None:
        """Same topic and type, but the offer falls short of the request."""

    def message_lost(self, subscription: Endpoint, count: int) -> None:
        """So many samples of a publisher did not reach the subscription."""

    def incompatible_type(self, local: Endpoint, remote: Endpoint) -> None:
        """Same topic, another type or another definition of it: they do not meet."""


class PublisherPort(ABC):
    """A publisher's door into a transport."""

    __slots__ = ()

    @property
    def initial_sequence(self) -> int:
        """Last sequence number sent under this gid by an earlier publisher."""
        return 0

    @abstractmethod
    def send(self, message: Any, source_ns: int, sequence: int) -> None:
        """Deliver ``message`` as it is now; later edits by the caller are unseen."""

    def assert_alive(self) -> bool:
        """Say without a sample that it is alive; whether all who listen are told."""
        return True

    @property
    @abstractmethod
    def matched_count(self) -> int:
        """How many subscriptions the samples go to through this transport."""

    @abstractmethod
    def close(self) -> None:
        """Leave the topic; closing twice is harmless."""


class SubscriptionPort(ABC):
    """A subscription's door into a transport."""

    __slots__ = ()

    @property
    @abstractmethod
    def matched_count(self) -> int:
        """How many publishers are heard through this transport."""

    @abstractmethod
    def close(self) -> None:
        """Leave the topic; closing twice is harmless."""


class Transport(ABC):
    """Moves samples between endpoints of the same topic name and type."""

    @abstractmethod
    def advertise(self, endpoint: Endpoint, message_class: type) -> PublisherPort:
        """Open a publisher's port.

        Raises:
            InvalidValueError: the topic carries another type; both are named.
        """

    @abstractmethod
    def subscribe(
        self, endpoint: Endpoint, message_class: type, sink: Sink, *, shared: bool
    ) -> SubscriptionPort:
        """Open a subscription's port; latched samples reach ``sink`` at once.

        ``shared`` samples may be the same object for several sinks: read-only.

        Raises:
            InvalidValueError: the topic carries another type; both are named.
        """

    @abstractmethod
    def serve(self, endpoint: Endpoint, sink: RequestSink) -> ServicePort:
        """Open a server's port.

        Raises:
            InvalidValueError: the service is of another type; both are named.
        """

    @abstractmethod
    def connect(self, endpoint: Endpoint, sink: ReplySink) -> ClientPort:
        """Open the port of a service's client.

        Raises:
            InvalidValueError: the service is of another type; both are named.
        """

    def announce(self, node: NodeInfo) -> None:
        """A node is here from now on; in process nobody needs telling."""
        return

    def withdraw(self, node: NodeInfo) -> None:
        """A node of :meth:`announce` is gone."""
        return

    def gid_for(self, endpoint: Endpoint) -> bytes | None:
        """The id under which a new endpoint will be known; None = any will do."""
        return None

    def remote_nodes(self) -> list[NodeInfo]:
        """Nodes of other processes, in order of appearance."""
        return []

    @abstractmethod
    def endpoints(self) -> list[Endpoint]:
        """All endpoints of topics that can be seen, in order of appearance."""

    @abstractmethod
    def service_endpoints(self) -> list[Endpoint]:
        """All servers and clients that can be seen, in order of appearance."""

    @abstractmethod
    def observe(self, observer: TransportObserver) -> None:
        """Report changes to ``observer`` from now on."""

    @abstractmethod
    def close(self) -> None:
        """Close every port."""
