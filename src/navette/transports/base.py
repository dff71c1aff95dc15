"""Interface of a transport: moves samples between endpoints of the same topic and type.

The runtime opens a port for each publisher, subscription, server and client on every
transport of its context. A transport that serialises does so inside its ports, and only
while a remote endpoint is matched. Actions are services and topics; a transport has no
notion of them, nor of nodes.
"""

import math
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

The message is an :class:`~navette.transports.encoded.Encoded` if the sample arrived as
bytes, and an :class:`~navette.transports.expiring.Expiring` if it has a lifespan.
"""

Sink = Callable[[Item], None]
"""Takes one delivered sample; must only queue it and return."""


@dataclass(frozen=True)
class NodeInfo:
    """Name of a node in the graph."""

    name: str
    namespace: str
    enclave: str = "/"

    @property
    def full_name(self) -> str:
        return f"{self.namespace.rstrip('/')}/{self.name}"


class EndpointKind(Enum):
    """Role of an endpoint on its topic or service."""

    PUBLISHER = 1
    SUBSCRIPTION = 2
    SERVICE = 3
    CLIENT = 4

    # Each is one object; Enum's own hash is computed in Python at every look-up.
    __hash__ = object.__hash__


@dataclass(frozen=True, slots=True)
class Endpoint:
    """One endpoint in the graph, described by names.

    Attributes:
        topic: name of the topic, or of the service for servers and clients.
        type_hash: announced hash of a remote endpoint; empty for a local one, whose
            type is the one of this process.
        other_types: further types that the topic may have; a node that accepts several
            types has one subscription for each.
        ignores_own_node: whether a subscription receives nothing from the publishers
            of its own node.
    """

    kind: EndpointKind
    topic: str
    type_name: str
    qos: EndpointQos
    node_name: str
    node_namespace: str
    gid: bytes
    type_hash: str = ""
    other_types: tuple[str, ...] = ()
    ignores_own_node: bool = False

    @property
    def is_remote(self) -> bool:
        """Whether the endpoint belongs to another process."""
        return bool(self.type_hash)

    @property
    def node_full_name(self) -> str:
        return f"{self.node_namespace.rstrip('/')}/{self.node_name}"


class TransportObserver:
    """Callbacks of a transport; override those of interest."""

    def graph_changed(self) -> None:
        """Handle that an endpoint or node was added or removed."""

    def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        """Handle that two endpoints exchange samples from now on."""

    def unmatched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        """Handle that two endpoints no longer exchange samples."""

    def asserted(self, publisher: Endpoint, subscription: Endpoint) -> None:
        """Handle that a remote MANUAL_BY_TOPIC publisher asserted its liveliness."""

    def incompatible_qos(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> None:
        """Handle that the offered QoS does not satisfy the requested QoS."""

    def message_lost(self, subscription: Endpoint, count: int) -> None:
        """Handle that samples of a publisher did not reach the subscription."""

    def incompatible_type(self, local: Endpoint, remote: Endpoint) -> None:
        """Handle that two endpoints of a topic have different type names or hashes."""


class PublisherPort(ABC):
    """Port of one publisher on a transport."""

    @property
    def initial_sequence(self) -> int:
        """Last sequence number sent under this gid by an earlier publisher."""
        return 0

    @abstractmethod
    def send(self, message: Any, source_ns: int, sequence: int) -> None:
        """Deliver ``message`` as it is now; later changes have no effect."""

    def hand_over(self, message: Any, source_ns: int, sequence: int) -> None:
        """Deliver a message that the caller does not change any more.

        Its float32 fields hold values of 32 bits. Receivers of shared messages get the
        message itself.
        """
        self.send(message, source_ns, sequence)

    def assert_alive(self) -> bool:
        """Assert liveliness without a sample; return whether it reaches everyone."""
        return True

    @property
    @abstractmethod
    def matched_count(self) -> int:
        """Number of subscriptions that receive the samples through this transport."""

    @property
    def most_hz(self) -> float:
        """The rate that all these subscriptions agree on; infinite: every sample."""
        return math.inf

    @abstractmethod
    def close(self) -> None:
        """Leave the topic; may be called again."""


class SubscriptionPort(ABC):
    """Port of one subscription on a transport."""

    #: The subscription uses the last sample of each period only; infinite: all.
    most_hz: float = math.inf

    @property
    @abstractmethod
    def matched_count(self) -> int:
        """Number of publishers whose samples arrive through this transport."""

    @abstractmethod
    def close(self) -> None:
        """Leave the topic; may be called again."""


class Transport(ABC):
    """Moves samples between endpoints of the same topic name and type.

    Opening a port raises InvalidValueError if the topic or service has another type;
    the message names both types.
    """

    @abstractmethod
    def advertise(self, endpoint: Endpoint, message_class: type) -> PublisherPort:
        """Open a publisher's port."""

    @abstractmethod
    def subscribe(
        self, endpoint: Endpoint, message_class: type, sink: Sink, *, shared: bool
    ) -> SubscriptionPort:
        """Open a subscription's port; latched samples reach ``sink`` at once.

        Args:
            shared: samples may be one object for several sinks, which only read it.
        """

    @abstractmethod
    def serve(self, endpoint: Endpoint, sink: RequestSink) -> ServicePort:
        """Open a server's port."""

    @abstractmethod
    def connect(self, endpoint: Endpoint, sink: ReplySink) -> ClientPort:
        """Open a client's port."""

    def announce(self, node: NodeInfo) -> None:
        """Add a node to the graph of other processes."""
        return

    def withdraw(self, node: NodeInfo) -> None:
        """Remove a node that :meth:`announce` has added."""
        return

    def gid_for(self, endpoint: Endpoint) -> bytes | None:
        """Return the gid that a new endpoint must have; None: any."""
        return None

    def remote_nodes(self) -> list[NodeInfo]:
        """Return the nodes of other processes, in order of appearance."""
        return []

    @abstractmethod
    def endpoints(self, topic: str | None = None) -> list[Endpoint]:
        """Return the visible endpoints of a topic, or all, in order of appearance."""

    @abstractmethod
    def service_endpoints(self) -> list[Endpoint]:
        """Return all visible servers and clients, in order of appearance."""

    @abstractmethod
    def observe(self, observer: TransportObserver) -> None:
        """Report changes to ``observer`` from now on."""

    @abstractmethod
    def close(self) -> None:
        """Close every port."""
