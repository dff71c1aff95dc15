"""The seam that moves (topic, message) between endpoints, and what implements it."""

from navette.transports.base import (
    Endpoint,
    EndpointKind,
    Item,
    PublisherPort,
    Sink,
    SubscriptionPort,
    Transport,
    TransportObserver,
)
from navette.transports.inprocess import InProcessTransport
from navette.transports.qos import (
    INFINITE_NS,
    DurabilityPolicy,
    EndpointQos,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    ReliabilityPolicy,
    incompatible_policies,
)
from navette.transports.service_ports import (
    ClientPort,
    Reply,
    ReplySink,
    Request,
    RequestId,
    RequestSink,
    ServicePort,
)

__all__ = [
    "ClientPort",
    "DurabilityPolicy",
    "Endpoint",
    "EndpointKind",
    "EndpointQos",
    "HistoryPolicy",
    "INFINITE_NS",
    "InProcessTransport",
    "Item",
    "LivelinessPolicy",
    "PublisherPort",
    "QoSPolicyKind",
    "ReliabilityPolicy",
    "Reply",
    "ReplySink",
    "Request",
    "RequestId",
    "RequestSink",
    "ServicePort",
    "Sink",
    "SubscriptionPort",
    "Transport",
    "TransportObserver",
    "incompatible_policies",
]
