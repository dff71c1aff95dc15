"""The chain of stages that drives the robot, and the effect of a missing stage."""

from collections.abc import Iterable

from navette.cli.doctor.snapshot import Snapshot
from navette.msgs.topics import CHAIN, LIDAR, ODOMETRY, ChainLink

_STOPPED_MPS = 0.03

#: Topics without which the robot does not drive.
NEEDED = frozenset(
    {LIDAR.name, ODOMETRY.name, *(link.publishes.name for link in CHAIN)}
)


def missing_links(seen: Snapshot) -> list[ChainLink]:
    """Return missing stages whose input is published and whose output is subscribed."""
    unreached = _unreached_topics(seen)
    return [
        link
        for link in CHAIN
        if seen.publishers(link.reads.name)
        and seen.subscriptions(link.publishes.name)
        and not seen.publishers(link.publishes.name)
        and link.publishes.name not in unreached
    ]


def explained(seen: Snapshot) -> set[str]:
    """Return topics whose missing publisher is reported already."""
    missing = {link.publishes.name for link in missing_links(seen)}
    return missing | _unreached_topics(seen)


def _unreached_topics(seen: Snapshot) -> set[str]:
    return {topic for topics in seen.unreached_topics.values() for topic in topics}


def consequence(seen: Snapshot, topics: Iterable[str]) -> str:
    """Return what missing topics mean for the robot, as the end of a sentence."""
    return robot_clause(seen) if NEEDED.intersection(topics) else ""


def robot_clause(seen: Snapshot) -> str:
    """Return the end of a sentence on the robot's motion; empty if it is unknown."""
    return "" if seen.speed_mps is None else f"; {motion(seen.speed_mps)}"


def motion(speed_mps: float) -> str:
    """Describe the robot's motion, from its odometry."""
    if speed_mps < _STOPPED_MPS:
        return "the robot is stopped"
    return f"the robot drives at {speed_mps:.1f} m/s"
