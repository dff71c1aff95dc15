"""What drives the robot: which stage makes what of what, and what is missed without."""

from collections.abc import Iterable
from typing import NamedTuple

from navette.cli.doctor.snapshot import Snapshot

_STANDS_MPS = 0.03


class Link(NamedTuple):
    """A stage of the stack: what it reads, and what it makes of it."""

    stage: str
    reads: str
    makes: str


CHAIN = (
    Link("costmap", "/lidar", "/costmap"),
    Link("map_memory", "/costmap", "/map"),
    Link("planner", "/map", "/path"),
    Link("control", "/path", "/cmd_vel"),
)

#: Nobody drives without them.
NEEDED = frozenset({"/lidar", "/odom/filtered", *(link.makes for link in CHAIN)})


def missing_links(seen: Snapshot) -> list[Link]:
    """Stages that are not there, between others that are."""
    unreached = {topic for topics in seen.unreached_topics.values() for topic in topics}
    return [
        link
        for link in CHAIN
        if seen.publishers(link.reads)
        and seen.subscriptions(link.makes)
        and not seen.publishers(link.makes)
        and link.makes not in unreached
    ]


def explained(seen: Snapshot) -> set[str]:
    """Topics that nobody publishes for a reason that is told already."""
    unreached = {topic for topics in seen.unreached_topics.values() for topic in topics}
    return unreached | {link.makes for link in missing_links(seen)}


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
