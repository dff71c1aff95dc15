"""QoS as bags store it, and as nodes use it."""

from navette.bags.qos import OfferedQos
from navette.runtime import (
    DurabilityPolicy,
    Duration,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)


def offer_of(profile: QoSProfile) -> OfferedQos:
    """Return the profile of a publisher as bags store it."""
    qos = profile.to_endpoint_qos()
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
    return QoSProfile(
        history=HistoryPolicy[offer.history.upper()],
        depth=offer.depth,
        reliability=ReliabilityPolicy[offer.reliability.upper()],
        durability=DurabilityPolicy[offer.durability.upper()],
        deadline=Duration(nanoseconds=offer.deadline_ns),
        lifespan=Duration(nanoseconds=offer.lifespan_ns),
        liveliness=LivelinessPolicy[offer.liveliness.upper()],
        liveliness_lease_duration=Duration(nanoseconds=offer.lease_ns),
    )
