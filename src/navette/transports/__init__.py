"""The seam that moves (topic, message) between endpoints, and what implements it."""

from navette.transports.base import (
    Endpoint,
    EndpointKind,
    Item,
    NodeInfo,
    PublisherPort,
    SubscriptionPort,
    Transport,
    TransportObserver,
)
from navette.transports.encoded import Encoded
from navette.transports.expiring import Expiring
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
    Request,
    RequestId,
    ServicePort,
)

__all__ = [
    "ClientPort",
    "DurabilityPolicy",
    "Encoded",
    "Endpoint",
    "EndpointKind",
    "EndpointQos",
    "Expiring",
    "HistoryPolicy",
    "INFINITE_NS",
    "InProcessTransport",
    "Item",
    "LivelinessPolicy",
    "NodeInfo",
    "PublisherPort",
    "QoSPolicyKind",
    "ReliabilityPolicy",
    "Reply",
    "Request",
    "RequestId",
    "ServicePort",
    "SubscriptionPort",
    "Transport",
    "TransportObserver",
    "incompatible_policies",
]
