"""Quality of service as text, in the form that rosbag2 stores in a bag."""

from collections.abc import Iterable
from dataclasses import dataclass

_INFINITE_NS = 2**63 - 1


@dataclass(frozen=True)
class OfferedQos:
    """What one publisher offers; policy names as in ROS 2, lower case."""

    history: str = "keep_last"
    depth: int = 10
    reliability: str = "reliable"
    durability: str = "volatile"
    deadline_ns: int = _INFINITE_NS
    lifespan_ns: int = _INFINITE_NS
    liveliness: str = "automatic"
    lease_ns: int = _INFINITE_NS


def qos_text(offers: Iterable[OfferedQos]) -> str:
    """YAML of a channel's ``offered_qos_profiles`` (rosbag2, Jazzy); "" for none."""
    return "\n".join(_profile(offer) for offer in offers)


def _profile(offer: OfferedQos) -> str:
    return "\n".join(
        (
            f"- history: {offer.history}",
            f"  depth: {offer.depth}",
            f"  reliability: {offer.reliability}",
            f"  durability: {offer.durability}",
            *_duration("deadline", offer.deadline_ns),
            *_duration("lifespan", offer.lifespan_ns),
            f"  liveliness: {offer.liveliness}",
            *_duration("liveliness_lease_duration", offer.lease_ns),
            "  avoid_ros_namespace_conventions: false",
        )
    )


def _duration(name: str, duration_ns: int) -> tuple[str, str, str]:
    seconds, nanoseconds = divmod(duration_ns, 1_000_000_000)
    return f"  {name}:", f"    sec: {seconds}", f"    nsec: {nanoseconds}"
