"""QoS profiles with rclpy's names."""

from enum import Enum, IntEnum
from typing import Any

from navette.errors import InvalidValueError
from navette.runtime.time import Duration
from navette.transports.qos import (
    BEST_AVAILABLE_NS,
    INFINITE_NS,
    EndpointQos,
    incompatible_policies,
)
from navette.transports.qos import DurabilityPolicy as DurabilityPolicy
from navette.transports.qos import HistoryPolicy as HistoryPolicy
from navette.transports.qos import LivelinessPolicy as LivelinessPolicy
from navette.transports.qos import QoSPolicyEnum as QoSPolicyEnum
from navette.transports.qos import QoSPolicyKind as QoSPolicyKind
from navette.transports.qos import ReliabilityPolicy as ReliabilityPolicy

QoSHistoryPolicy = HistoryPolicy
QoSReliabilityPolicy = ReliabilityPolicy
QoSDurabilityPolicy = DurabilityPolicy
QoSLivelinessPolicy = LivelinessPolicy

#: The other endpoint's value counts; the second name is misspelled in rclpy.
DeadlineBestAvailable = Duration(nanoseconds=BEST_AVAILABLE_NS)
LivelinessLeaseDurationeBestAvailable = Duration(nanoseconds=BEST_AVAILABLE_NS)


class InvalidQoSProfileException(  # noqa: N818 - rclpy's name
    InvalidValueError, AssertionError
):
    """The profile's settings are invalid, incomplete or contradict each other."""


class QoSProfile:
    """Quality of service of a publisher or subscription.

    Either ``depth`` (which implies keep_last) or ``history`` is required.
    """

    __slots__ = (
        "avoid_ros_namespace_conventions",
        "deadline",
        "depth",
        "durability",
        "history",
        "lifespan",
        "liveliness",
        "liveliness_lease_duration",
        "reliability",
    )

    def __init__(
        self,
        history: HistoryPolicy | int | None = None,
        depth: int | None = None,
        reliability: ReliabilityPolicy | int = ReliabilityPolicy.RELIABLE,
        durability: DurabilityPolicy | int = DurabilityPolicy.VOLATILE,
        lifespan: Duration | None = None,
        deadline: Duration | None = None,
        liveliness: LivelinessPolicy | int = LivelinessPolicy.SYSTEM_DEFAULT,
        liveliness_lease_duration: Duration | None = None,
        avoid_ros_namespace_conventions: bool = False,
    ) -> None:
        if history is None:
            if depth is None:
                raise InvalidQoSProfileException(
                    "QoS profile: history or depth is required"
                )
            history = HistoryPolicy.KEEP_LAST
        if history == HistoryPolicy.KEEP_LAST and depth is None:
            raise InvalidQoSProfileException(
                "QoS profile: history KEEP_LAST requires a depth"
            )
        self.history = HistoryPolicy(history)
        self.depth = _checked_depth(10 if depth is None else depth)
        self.reliability = ReliabilityPolicy(reliability)
        self.durability = DurabilityPolicy(durability)
        self.lifespan = _checked_duration("lifespan", lifespan)
        self.deadline = _checked_duration("deadline", deadline)
        self.liveliness = LivelinessPolicy(liveliness)
        self.liveliness_lease_duration = _checked_duration(
            "liveliness_lease_duration", liveliness_lease_duration
        )
        self.avoid_ros_namespace_conventions = avoid_ros_namespace_conventions

    def to_endpoint_qos(self) -> EndpointQos:
        """Return the transport's QoS; a duration of zero (unspecified) is infinite."""
        return EndpointQos(
            history=HistoryPolicy(self.history),
            depth=self.depth,
            reliability=ReliabilityPolicy(self.reliability),
            durability=DurabilityPolicy(self.durability),
            deadline_ns=self.deadline.nanoseconds or INFINITE_NS,
            lifespan_ns=self.lifespan.nanoseconds or INFINITE_NS,
            liveliness=LivelinessPolicy(self.liveliness),
            lease_ns=self.liveliness_lease_duration.nanoseconds or INFINITE_NS,
        )

    @classmethod
    def from_endpoint_qos(cls, qos: EndpointQos) -> "QoSProfile":
        """Return the profile of an endpoint, for graph queries."""
        return cls(
            history=qos.history,
            depth=qos.depth,
            reliability=qos.reliability,
            durability=qos.durability,
            lifespan=Duration(nanoseconds=qos.lifespan_ns),
            deadline=Duration(nanoseconds=qos.deadline_ns),
            liveliness=qos.liveliness,
            liveliness_lease_duration=Duration(nanoseconds=qos.lease_ns),
        )

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QoSProfile):
            return NotImplemented
        return all(getattr(self, n) == getattr(other, n) for n in self.__slots__)

    def __hash__(self) -> int:
        return hash(tuple(getattr(self, name) for name in self.__slots__))

    def __repr__(self) -> str:
        fields = ", ".join(f"{n}={_shown(getattr(self, n))}" for n in self.__slots__)
        return f"QoSProfile({fields})"

    __str__ = __repr__


def _shown(value: Any) -> str:
    return getattr(value, "name", None) or str(value)


def _checked_duration(name: str, value: Duration | None) -> Duration:
    if value is not None and not isinstance(value, Duration):
        raise InvalidQoSProfileException(
            f"QoS {name} {value!r}: expected a Duration, as in Duration(seconds=1.0)"
        )
    return value or Duration()


def _checked_depth(depth: Any) -> int:
    if not isinstance(depth, int) or isinstance(depth, bool) or depth < 0:
        raise InvalidQoSProfileException(f"QoS depth {depth!r}: expected an int >= 0")
    return depth


def as_profile(qos_or_depth: "QoSProfile | int") -> QoSProfile:
    """Return a profile unchanged, or keep_last with the given depth.

    Raises:
        TypeError: the argument is neither a profile nor a depth.
        InvalidQoSProfileException: the depth is negative.
    """
    if isinstance(qos_or_depth, QoSProfile):
        return qos_or_depth
    if isinstance(qos_or_depth, bool) or not isinstance(qos_or_depth, int):
        raise TypeError(
            f"qos_profile {qos_or_depth!r}: expected a QoSProfile or a depth (int)"
        )
    return QoSProfile(depth=qos_or_depth)


qos_profile_default = QoSProfile(depth=10)
qos_profile_unknown = QoSProfile(
    history=HistoryPolicy.UNKNOWN,
    depth=0,
    reliability=ReliabilityPolicy.UNKNOWN,
    durability=DurabilityPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)
qos_profile_system_default = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    depth=0,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
)
qos_profile_sensor_data = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = QoSProfile(depth=10)
qos_profile_parameters = QoSProfile(depth=1000)
qos_profile_parameter_events = QoSProfile(depth=1000)
qos_profile_rosout_default = QoSProfile(
    depth=1000,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    lifespan=Duration(seconds=10),
)
qos_profile_action_status_default = QoSProfile(
    depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL
)
qos_profile_best_available = QoSProfile(
    depth=10,
    reliability=ReliabilityPolicy.BEST_AVAILABLE,
    durability=DurabilityPolicy.BEST_AVAILABLE,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
)


class QoSPresetProfiles(Enum):
    """Preset profiles by name."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available

    @classmethod
    def short_keys(cls) -> list[str]:
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        profile: QoSProfile = cls[name.upper()].value
        return profile


def qos_policy_name_from_kind(policy_kind: QoSPolicyKind | int) -> str:
    return QoSPolicyKind(policy_kind).name


class QoSCompatibility(IntEnum):
    """Whether a publisher and a subscription match, with rmw's values."""

    OK = 0
    WARNING = 1
    ERROR = 2


def qos_check_compatible(
    publisher_qos: QoSProfile, subscription_qos: QoSProfile
) -> tuple[QoSCompatibility, str]:
    """Return whether the two endpoints match, and the reason if they do not."""
    offered = publisher_qos.to_endpoint_qos()
    requested = subscription_qos.to_endpoint_qos()
    incompatible = incompatible_policies(offered, requested)
    if incompatible:
        names = ", ".join(kind.name.lower() for kind in incompatible)
        return QoSCompatibility.ERROR, f"ERROR: incompatible: {names}"
    unspecified = [
        f"{side} {name}"
        for side, qos in (("publisher", offered), ("subscription", requested))
        for name in ("reliability", "durability")
        if getattr(qos, name).name in ("SYSTEM_DEFAULT", "UNKNOWN")
    ]
    if unspecified:
        return QoSCompatibility.WARNING, f"WARNING: not set: {', '.join(unspecified)}"
    return QoSCompatibility.OK, ""
