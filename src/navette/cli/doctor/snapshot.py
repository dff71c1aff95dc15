"""Input of the checks: the graph and the responses of its nodes, as plain values."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from navette.transports import Endpoint, EndpointKind


@dataclass(frozen=True)
class StageStatus:
    """Newest message of a status topic.

    ``age_s`` is the time since it was published, None without a message; ``level`` is
    that of diagnostic_msgs/msg/DiagnosticStatus.
    """

    topic: str
    state: str = ""
    level: int = 0
    age_s: float | None = None


@dataclass(frozen=True)
class Snapshot:
    """The graph at one moment.

    Args:
        nodes: full names; duplicate names are kept.
        endpoints: publishers and subscriptions.
        services: servers and clients.
        sim_time: use_sim_time by full name; None if the node did not respond.
        unreached: full names of nodes that the router lists but that are not visible.
        unreached_topics: published topics of each of these.
        speed_mps: speed of the robot from its odometry; None if unknown.
        clock_ticks: whether /clock has messages.
        heartbeats: newest message of every status topic.
    """

    nodes: tuple[str, ...] = ()
    endpoints: tuple[Endpoint, ...] = ()
    services: tuple[Endpoint, ...] = ()
    sim_time: Mapping[str, bool | None] = field(default_factory=dict)
    unreached: tuple[str, ...] = ()
    unreached_topics: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    speed_mps: float | None = None
    clock_ticks: bool = False
    heartbeats: tuple[StageStatus, ...] = ()

    def publishers(self, topic: str) -> list[Endpoint]:
        return self._of(topic, EndpointKind.PUBLISHER)

    def published_by(self, node: str) -> list[str]:
        """Return the topics that a visible node publishes."""
        kind = EndpointKind.PUBLISHER
        found = (e for e in self.endpoints if e.kind is kind)
        return sorted({e.topic for e in found if e.node_full_name == node})

    def subscriptions(self, topic: str) -> list[Endpoint]:
        return self._of(topic, EndpointKind.SUBSCRIPTION)

    @property
    def topics(self) -> list[str]:
        """Topics except hidden and standard ones, sorted."""
        return sorted({e.topic for e in self.endpoints if not is_own(e.topic)})

    def _of(self, topic: str, kind: EndpointKind) -> list[Endpoint]:
        return [e for e in self.endpoints if e.topic == topic and e.kind is kind]


_EVERY_NODE_HAS = {"/rosout", "/parameter_events"}


def is_own(name: str) -> bool:
    """Whether a topic is hidden or one that every node has."""
    return name in _EVERY_NODE_HAS or any(
        part.startswith("_") for part in name.split("/")
    )
