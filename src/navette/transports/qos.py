"""Quality of service of endpoints, and which offers satisfy which requests.

Enum values are those of ROS 2's ``rmw_qos_*_policy_t``: bags and the wire contain them.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import Self

INFINITE_NS = 2**63 - 1
"""RMW_DURATION_INFINITE in nanoseconds."""

BEST_AVAILABLE_NS = INFINITE_NS - 1
"""A deadline or lease that is compatible with any other."""

DEFAULT_DEPTH = 42
"""Queue depth if the profile does not set one, as in rmw_zenoh."""


class QoSPolicyEnum(IntEnum):
    """Base of the policy enums, with short names for command lines and files."""

    @classmethod
    def short_keys(cls) -> list[str]:
        return [each.name.lower() for each in cls]  # without aliases

    @classmethod
    def get_from_short_key(cls, name: str) -> int:
        return cls[name.upper()].value

    @property
    def short_key(self) -> str:
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    """Which samples are kept: the last ``depth``, or all."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3

    # Names in older programs.
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

    # Names in older programs.
    RMW_QOS_POLICY_RELIABILITY_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    RMW_QOS_POLICY_RELIABILITY_RELIABLE = RELIABLE
    RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT = BEST_EFFORT
    RMW_QOS_POLICY_RELIABILITY_UNKNOWN = UNKNOWN


class DurabilityPolicy(QoSPolicyEnum):
    """Whether late joiners receive the last samples (TRANSIENT_LOCAL)."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4

    # Names in older programs.
    RMW_QOS_POLICY_DURABILITY_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    RMW_QOS_POLICY_DURABILITY_TRANSIENT_LOCAL = TRANSIENT_LOCAL
    RMW_QOS_POLICY_DURABILITY_VOLATILE = VOLATILE
    RMW_QOS_POLICY_DURABILITY_UNKNOWN = UNKNOWN


class LivelinessPolicy(QoSPolicyEnum):
    """How a publisher asserts that it is alive."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5

    # Names in older programs.
    RMW_QOS_POLICY_LIVELINESS_SYSTEM_DEFAULT = SYSTEM_DEFAULT
    RMW_QOS_POLICY_LIVELINESS_AUTOMATIC = AUTOMATIC
    RMW_QOS_POLICY_LIVELINESS_MANUAL_BY_TOPIC = MANUAL_BY_TOPIC
    RMW_QOS_POLICY_LIVELINESS_UNKNOWN = UNKNOWN


class QoSPolicyKind(IntEnum):
    """Policy named by an incompatible-QoS event; values as in rmw."""

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
        """Maximum number of queued samples; None: unlimited."""
        if self.history == HistoryPolicy.KEEP_ALL:
            return None
        return self.depth or DEFAULT_DEPTH

    @property
    def is_latched(self) -> bool:
        """Whether the endpoint keeps or requests samples for late joiners."""
        return self.durability in (
            DurabilityPolicy.TRANSIENT_LOCAL,
            DurabilityPolicy.BEST_AVAILABLE,
        )

    @property
    def asserts_itself(self) -> bool:
        """Whether a publisher is alive only within its lease after a message."""
        manual = self.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
        return manual and 0 < self.lease_ns < INFINITE_NS

    @classmethod
    def latched(cls, depth: int = 1) -> Self:
        """Return reliable, transient local: for maps and robot descriptions."""
        return cls(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def incompatible_policies(
    offered: EndpointQos, requested: EndpointQos
) -> tuple[QoSPolicyKind, ...]:
    """Return the policies in which an offer does not satisfy a request.

    Rules: requested versus offered (OMG DDS 1.4, 2.2.3).
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
