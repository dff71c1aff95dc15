"""Zenoh publishers and subscribers for a QoS profile; the advanced ones resend samples.

zenoh-ext's advanced publisher keeps its last samples. Its advanced subscriber fetches
them when it finds the publisher (history, for transient local), and fetches the samples
that it missed (recovery). Both are used as in rmw_zenoh for transient-local endpoints,
and for the reliable topics that ``NAVETTE_RETRANSMIT`` lists. All other endpoints are
plain ones, because an advanced publisher declares a queryable and a token to every
other session (decision 0017).
"""

from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import Any

import zenoh
from zenoh import ext

from navette.transports.qos import EndpointQos, HistoryPolicy, ReliabilityPolicy
from navette.transports.zenoh.callbacks import direct

# As in rmw_zenoh: an idle publisher announces its last sequence number once.
_HEARTBEAT_S = 0.5
# Samples that KEEP_ALL keeps for late joiners.
_CACHE_OF_KEEP_ALL = 100_000


def retransmits(qos: EndpointQos, topic: str, patterns: tuple[str, ...]) -> bool:
    """Return whether lost samples of the endpoint are resent.

    Args:
        patterns: topic names or shell patterns of ``NAVETTE_RETRANSMIT``.
    """
    if qos.reliability != ReliabilityPolicy.RELIABLE:
        return False
    return qos.is_latched or any(fnmatchcase(topic, each) for each in patterns)


def declare_publisher(
    session: zenoh.Session,
    key: str,
    qos: EndpointQos,
    *,
    retransmits: bool,
    lossless: bool,
) -> Any:
    """Declare a plain or an advanced publisher.

    Args:
        lossless: block instead of dropping samples when a link is congested.
    """
    reliable = lossless or qos.reliability == ReliabilityPolicy.RELIABLE
    blocks = lossless or (reliable and qos.history == HistoryPolicy.KEEP_ALL)
    options: dict[str, Any] = {
        "reliability": (
            zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT
        ),
        # As in rmw_zenoh: a robot must not wait for a slow or lost subscriber.
        "congestion_control": (
            zenoh.CongestionControl.BLOCK if blocks else zenoh.CongestionControl.DROP
        ),
        "allowed_destination": zenoh.Locality.REMOTE,
    }
    if not (qos.is_latched or retransmits):
        return session.declare_publisher(key, **options)
    if retransmits:
        options["sample_miss_detection"] = ext.MissDetectionConfig(
            heartbeat=None, sporadic_heartbeat=_HEARTBEAT_S
        )
    return ext.declare_advanced_publisher(
        session,
        key,
        cache=ext.CacheConfig(qos.queue_length or _CACHE_OF_KEEP_ALL),
        publisher_detection=True,
        **options,
    )


def declare_subscriber(
    session: zenoh.Session,
    key: str,
    qos: EndpointQos,
    on_sample: Callable[[zenoh.Sample], None],
    *,
    retransmits: bool,
) -> Any:
    """Declare a plain or an advanced subscriber.

    Args:
        on_sample: called on Zenoh's threads.
    """
    handler = direct(on_sample)
    options: dict[str, Any] = {"allowed_origin": zenoh.Locality.REMOTE}
    if not (qos.is_latched or retransmits):
        return session.declare_subscriber(key, handler, **options)
    if qos.is_latched:
        options["history"] = ext.HistoryConfig(
            detect_late_publishers=True, max_samples=qos.queue_length
        )
    if retransmits:
        options["recovery"] = ext.RecoveryConfig(periodic_queries=None, heartbeat=True)
    return ext.declare_advanced_subscriber(session, key, handler, **options)
