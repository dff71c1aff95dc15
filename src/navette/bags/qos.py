"""Quality of service as text, in the format of rosbag2."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import yaml

from navette.files.untrusted.budget import QOS
from navette.files.untrusted.yaml_input import BoundedLoader, load_yaml

_INFINITE_NS = 2**63 - 1


@dataclass(frozen=True)
class OfferedQos:
    """QoS offered by one publisher; policy names as in ROS 2, lower case."""

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


# Numbers of rmw/types.h, written by rosbag2 up to Iron.
_NAMES = {
    "history": ("system_default", "keep_last", "keep_all", "unknown"),
    "reliability": (
        "system_default",
        "reliable",
        "best_effort",
        "unknown",
        "best_available",
    ),
    "durability": (
        "system_default",
        "transient_local",
        "volatile",
        "unknown",
        "best_available",
    ),
    "liveliness": (
        "system_default",
        "automatic",
        "manual_by_node",
        "manual_by_topic",
        "unknown",
        "best_available",
    ),
}
_MOST_OFFERS = 1000


def parse_qos(text: object) -> tuple[OfferedQos, ...]:
    """Parse the output of :func:`qos_text` or of any rosbag2 release.

    Invalid values become the default: QoS is a hint and never a reason to refuse a bag.
    """
    return _parsed(text) if isinstance(text, str) else _offers(text)


@lru_cache(maxsize=1024)  # topics with the same text are many
def _parsed(text: str) -> tuple[OfferedQos, ...]:
    try:
        return _offers(load_yaml(text, _QosLoader)) if text else ()
    except yaml.YAMLError:
        return ()


def _offers(found: object) -> tuple[OfferedQos, ...]:
    if not isinstance(found, list):
        return ()
    offers = found[:_MOST_OFFERS]
    return tuple(_offer(each) for each in offers if isinstance(each, dict))


class _QosLoader(BoundedLoader):
    BUDGET = QOS


def _offer(found: Mapping[str, Any]) -> OfferedQos:
    depth = found.get("depth")
    return OfferedQos(
        history=_policy("history", found),
        depth=depth if isinstance(depth, int) and depth >= 0 else OfferedQos.depth,
        reliability=_policy("reliability", found),
        durability=_policy("durability", found),
        liveliness=_policy("liveliness", found),
        deadline_ns=_nanoseconds(found.get("deadline")),
        lifespan_ns=_nanoseconds(found.get("lifespan")),
        lease_ns=_nanoseconds(found.get("liveliness_lease_duration")),
    )


def _policy(name: str, found: Mapping[str, Any]) -> str:
    names, value = _NAMES[name], found.get(name)
    if isinstance(value, int):
        value = names[value] if 0 <= value < len(names) else None
    default: str = getattr(OfferedQos, name)
    return value if isinstance(value, str) and value in names else default


def _nanoseconds(found: object) -> int:
    """Parse a duration; infinite by default, and for 0 s of older releases."""
    if not isinstance(found, dict):
        return _INFINITE_NS
    seconds, rest = found.get("sec"), found.get("nsec")
    if not isinstance(seconds, int) or not isinstance(rest, int):
        return _INFINITE_NS
    duration = seconds * 1_000_000_000 + rest
    return duration if 0 < duration < _INFINITE_NS else _INFINITE_NS
