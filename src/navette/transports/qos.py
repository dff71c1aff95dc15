"""Quality of service as a transport sees it, and which offers satisfy which requests.

Enum values are those of ROS 2's ``rmw_qos_*_policy_t``: they travel in bags and on
the wire.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import Self

INFINITE_NS = 2**63 - 1
"""RMW_DURATION_INFINITE in nanoseconds."""

BEST_AVAILABLE_NS = INFINITE_NS - 1
"""A deadline or lease that goes with whatever the other side has."""

DEFAULT_DEPTH = 42
"""Queue depth where the profile leaves it open (as in rmw_zenoh)."""


class QoSPolicyEnum(IntEnum):
    """Base of the policy enums: short names for command lines and files."""

    @classmethod
    def short_keys(cls) -> list[str]:
        return [each.name.lower() for each in cls]  # without the RMW_… aliases

    @classmethod
    def get_from_short_key(cls, name: str) -> int:
        return cls[name.upper()].value

    @property
    def short_key(self) -> str:
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    """How many samples are kept: the last ``depth``, or all."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3

    # The names of older programs.
    RMW_QOS_POLICY_HISTORY_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    RMW_QOS_POLICY_HISTORY_KEEP_LAST = KEEP_LAST
    RMW_QOS_POLICY_HISTORY_KEEP_ALL = KEEP_ALL
    RMW_QOS_POLICY_HISTORY_UNKNOWN = UNKNOWN


class ReliabilityPolicy(QoSPolicyEnum):
    """Whether every sample must arrive."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4

    # The names of older programs.
    RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    RMW_QOS_POLICY_RELIABILITY_RELIABLE = RELIABLE
    RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT = BEST_EFFORT
    RMW_QOS_POLICY_RELIABILITY_UNKNOWN = UNKNOWN


class DurabilityPolicy(QoSPolicyEnum):
    """Whether late joiners get the last samples (TRANSIENT_LOCAL)."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4

    # The names of older programs.
    RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL = TRANSIENT_LOCAL
    RMW_QOS_POLICY_DURABILITY_VOLATILE = VOLATILE
    RMW_QOS_POLICY_DURABILITY_UNKNOWN = UNKNOWN


class LivelinessPolicy(QoSPolicyEnum):
    """Who asserts that a publisher is alive."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5

    # The names of older programs.
    RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    RMW_QOS_POLICY_LIVELINESS_AUTOMATIC = AUTOMATIC
    RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC = MANUAL_BY_TOPIC
    RMW_QOS_POLICY_LIVELINESS_UNKNOWN = UNKNOWN


class QoSPolicyKind(IntEnum):
    """Names the policy in incompatible-QoS events; values as in rmw."""

    INVALID = 1
    DURABILITY = 2
    DEADLINE = 4
    LIVELINESS = 8
    RELIABILITY = 16
    HISTORY = 32
    LIFESPAN = 64
    DEPTH = 128
    LIVELINESS_LEASE_DURATION = 256
    AVOID_ROS_NAMESPACE_CONVENTIONS = 512


@dataclass(frozen=True, slots=True)
class EndpointQos:
    """The policies of one endpoint; durations in nanoseconds."""

    history: HistoryPolicy = HistoryPolicy.KEEP_LAST
    depth: int = 10
    reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE
    durability: DurabilityPolicy = DurabilityPolicy.VOLATILE
    deadline_ns: int = INFINITE_NS
    lifespan_ns: int = INFINITE_NS
    liveliness: LivelinessPolicy = LivelinessPolicy.AUTOMATIC
    lease_ns: int = INFINITE_NS

    @property
    def queue_length(self) -> int | None:
        """Samples a queue may hold; ``None`` = all of them."""
        if self.history == HistoryPolicy.KEEP_ALL:
            return None
        return self.depth or DEFAULT_DEPTH

    @property
    def is_latched(self) -> bool:
        """Whether this endpoint keeps (or wants) samples for late joiners."""
        return self.durability in (
            DurabilityPolicy.TRANSIENT_LOCAL,
            DurabilityPolicy.BEST_AVAILABLE,
        )

    @property
    def asserts_itself(self) -> bool:
        """Whether a publisher of that QoS is alive only for a while after a message."""
        manual = self.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
        return manual and 0 < self.lease_ns < INFINITE_NS

    @classmethod
    def latched(cls, depth: int = 1) -> Self:
        """Reliable, transient local: what maps and descriptions use."""
        return cls(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def incompatible_policies(
    offered: EndpointQos, requested: EndpointQos
) -> tuple[QoSPolicyKind, ...]:
    """The policies in which an offer falls short of a request; empty = they match.

    Rules: DDS request versus offered (OMG DDS 1.4, 2.2.3).
    """
    checks = (
        (
            QoSPolicyKind.RELIABILITY,
            requested.reliability
            in (ReliabilityPolicy.RELIABLE, ReliabilityPolicy.SYSTEM_DEFAULT)
            and offered.reliability == ReliabilityPolicy.BEST_EFFORT,
        ),
        (
            QoSPolicyKind.DURABILITY,
            requested.durability == DurabilityPolicy.TRANSIENT_LOCAL
            and not offered.is_latched,
        ),
        (
            QoSPolicyKind.DEADLINE,
            _is_longer(offered.deadline_ns, requested.deadline_ns),
        ),
        (
            QoSPolicyKind.LIVELINESS,
            requested.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC
            and offered.liveliness
            in (LivelinessPolicy.AUTOMATIC, LivelinessPolicy.SYSTEM_DEFAULT),
        ),
        (
            QoSPolicyKind.LIVELINESS_LEASE_DURATION,
            _is_longer(offered.lease_ns, requested.lease_ns),
        ),
    )
    return tuple(kind for kind, short in checks if short)


def _is_longer(offered_ns: int, requested_ns: int) -> bool:
    if BEST_AVAILABLE_NS in (offered_ns, requested_ns):
        return False
    return offered_ns > requested_ns
