"""Convert publishers, subscriptions and servers to the topics and graph of the
protocol."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from navette.viewer.replies import ConnectionGraph
from navette.viewer.session import Topic


@dataclass(frozen=True)
class TopicEnd:
    """One publisher or subscription; ``latched`` publishers keep their last samples."""

    topic: str
    type_name: str
    node: str
    publishes: bool
    latched: bool = False


def topics_of(
    ends: Iterable[TopicEnd], definition_of: Callable[[str, str], str | None]
) -> list[Topic]:
    """Return each topic and type once; latched if any of its publishers is.

    Args:
        definition_of: ros2msg definition of a topic's type; None omits the topic.
    """
    latched: dict[tuple[str, str], bool] = {}
    for end in ends:
        key = end.topic, end.type_name
        latched[key] = latched.get(key, False) or (end.publishes and end.latched)
    return [
        Topic(topic, type_name, definition, is_latched)
        for (topic, type_name), is_latched in latched.items()
        if (definition := definition_of(topic, type_name)) is not None
    ]


def graph_of(
    ends: Iterable[TopicEnd], servers: Iterable[tuple[str, str]] = ()
) -> ConnectionGraph:
    """Return the graph; ``servers``: pairs of a service and a node that serves it."""
    published: dict[str, set[str]] = {}
    subscribed: dict[str, set[str]] = {}
    for end in ends:
        side = published if end.publishes else subscribed
        side.setdefault(end.topic, set()).add(end.node)
    served: dict[str, set[str]] = {}
    for service, node in servers:
        served.setdefault(service, set()).add(node)
    return ConnectionGraph(_sorted(published), _sorted(subscribed), _sorted(served))


def is_hidden(name: str) -> bool:
    """Whether a part of a name begins with ``_``, as in the topics of actions."""
    return any(part.startswith("_") for part in name.split("/"))


def _sorted(names: dict[str, set[str]]) -> dict[str, tuple[str, ...]]:
    return {topic: tuple(sorted(nodes)) for topic, nodes in names.items()}
