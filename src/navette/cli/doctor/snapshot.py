"""What the checks look at, as plain values: the graph and what its nodes answered."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from navette.transports import Endpoint, EndpointKind


@dataclass(frozen=True)
class Heartbeat:
    """The newest word on a status topic.

    ``age_s`` is the time since it was sent, or None where none came; ``level`` is
    diagnostic_msgs/msg/DiagnosticStatus's.
    """

    topic: str
    state: str = ""
    level: int = 0
    age_s: float | None = None


@dataclass(frozen=True)
class Snapshot:
    """The graph at one moment.

    Args:
        nodes: full names; a name that two nodes share is in it twice.
        endpoints: of topics.
        services: servers and clients.
        sim_time: full names of the nodes that were asked → what their use_sim_time
            is; None if they did not answer in time.
        unreached: full names of nodes that the router knows, but that are not seen.
        unreached_topics: of each of these → what it publishes.
        speed_mps: how fast the robot drives, by its odometry; None: nobody says.
        clock_ticks: whether a message came on /clock.
        heartbeats: of every status topic.
    """

    nodes: tuple[str, ...] = ()
    endpoints: tuple[Endpoint, ...] = ()
    services: tuple[Endpoint, ...] = ()
    sim_time: Mapping[str, bool | None] = field(default_factory=dict)
    unreached: tuple[str, ...] = ()
    unreached_topics: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    speed_mps: float | None = None
    clock_ticks: bool = False
    heartbeats: tuple[Heartbeat, ...] = ()

    def publishers(self, topic: str) -> list[Endpoint]:
        return self._of(topic, EndpointKind.PUBLISHER)

    def published_by(self, node: str) -> list[str]:
        """Topics, by the full name of a node that is seen."""
        kind = EndpointKind.PUBLISHER
        found = (e for e in self.endpoints if e.kind is kind)
        return sorted({e.topic for e in found if e.node_full_name == node})

    def subscriptions(self, topic: str) -> list[Endpoint]:
        return self._of(topic, EndpointKind.SUBSCRIPTION)

    @property
    def topics(self) -> list[str]:
        """Those that people use, sorted."""
        return sorted({e.topic for e in self.endpoints if not is_own(e.topic)})

    def _of(self, topic: str, kind: EndpointKind) -> list[Endpoint]:
        return [e for e in self.endpoints if e.topic == topic and e.kind is kind]


_EVERY_NODE_HAS = {"/rosout", "/parameter_events"}


def is_own(name: str) -> bool:
    """Whether a topic is the machinery's: hidden, or one that every node has."""
    return name in _EVERY_NODE_HAS or any(
        part.startswith("_") for part in name.split("/")
    )
