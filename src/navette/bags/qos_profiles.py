"""QoS as bags store it, and as publishers have it."""

from navette.bags.qos import OfferedQos
from navette.runtime.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from navette.transports import EndpointQos


def offer_of(qos: EndpointQos) -> OfferedQos:
    """Return the QoS of a publisher as bags store it."""
    return OfferedQos(
        history=qos.history.short_key,
        depth=qos.depth,
        reliability=qos.reliability.short_key,
        durability=qos.durability.short_key,
        deadline_ns=qos.deadline_ns,
        lifespan_ns=qos.lifespan_ns,
        liveliness=qos.liveliness.short_key,
        lease_ns=qos.lease_ns,
    )


def profile_of(offer: OfferedQos) -> QoSProfile:
    """Return the profile of a publisher that offers the same."""
    return QoSProfile.from_endpoint_qos(
        EndpointQos(
            history=HistoryPolicy[offer.history.upper()],
            depth=offer.depth,
            reliability=ReliabilityPolicy[offer.reliability.upper()],
            durability=DurabilityPolicy[offer.durability.upper()],
            deadline_ns=offer.deadline_ns,
            lifespan_ns=offer.lifespan_ns,
            liveliness=LivelinessPolicy[offer.liveliness.upper()],
            lease_ns=offer.lease_ns,
        )
    )
