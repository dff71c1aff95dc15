"""What drives the robot: which stage makes what of what, and what is missed without."""

from collections.abc import Iterable

from navette.cli.doctor.snapshot import Snapshot
from navette.topics import CHAIN, LIDAR, ODOMETRY, Link

_STANDS_MPS = 0.03


#: Topics without which the robot does not drive.
NEEDED = frozenset(
    {LIDAR.name, ODOMETRY.name, *(link.publishes.name for link in CHAIN)}
)


def missing_links(seen: Snapshot) -> list[Link]:
    """Stages that are not there, between others that are."""
    unreached = {topic for topics in seen.unreached_topics.values() for topic in topics}
    return [
        link
        for link in CHAIN
        if seen.publishers(link.reads.name)
        and seen.subscriptions(link.publishes.name)
        and not seen.publishers(link.publishes.name)
        and link.publishes.name not in unreached
    ]


def explained(seen: Snapshot) -> set[str]:
    """Topics that nobody publishes for a reason that is told already."""
    unreached = {topic for topics in seen.unreached_topics.values() for topic in topics}
    return unreached | {link.publishes.name for link in missing_links(seen)}


def consequence(seen: Snapshot, topics: Iterable[str]) -> str:
    """What it means for the robot that these are not published; empty for nothing."""
    return and_the_robot(seen) if NEEDED.intersection(topics) else ""


def and_the_robot(seen: Snapshot) -> str:
    """The end of a sentence: what the robot does; empty where nobody says."""
    return "" if seen.speed_mps is None else f"; {robot(seen.speed_mps)}"


def robot(speed_mps: float) -> str:
    """What the robot does, by its odometry."""
    if speed_mps < _STANDS_MPS:
        return "the robot stands"
    return f"the robot drives at {speed_mps:.1f} m/s"
