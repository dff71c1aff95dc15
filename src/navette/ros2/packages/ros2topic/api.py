"""Topics of the graph, message classes by name, QoS from short words."""

from argparse import ArgumentTypeError
from collections.abc import Callable, Iterable
from typing import Any

from navette.ros2.packages.ros2cli.node.strategy import NodeStrategy
from navette.ros2.packages.rosidl_runtime_py.utilities import get_message
from navette.runtime import Duration, Node, QoSPresetProfiles, QoSProfile
from navette.runtime.names import expand_topic_name, topic_or_service_is_hidden
from navette.runtime.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    ReliabilityPolicy,
)

__all__ = [
    "TopicNameCompleter",
    "get_msg_class",
    "get_topic_names",
    "get_topic_names_and_types",
    "import_message_type",
    "positive_float",
    "profile_configure_short_keys",
    "qos_profile_from_short_keys",
    "unsigned_int",
]


def unsigned_int(string: str) -> int:
    """Parse 0 or a positive integer, as a type of argparse."""
    return int(_number(int, string, lambda value: value >= 0, "an integer, 0 or more"))


def positive_float(string: str) -> float:
    """Parse a number above 0, as a type of argparse."""
    return float(_number(float, string, lambda value: value > 0, "a number above 0"))


def _number(kind: Any, text: str, holds: Callable[[Any], bool], expected: str) -> Any:
    try:
        value = kind(text)
    except ValueError:
        value = None
    if value is None or not holds(value):
        raise ArgumentTypeError(f"{text!r}: expected {expected}")
    return value


def get_topic_names_and_types(
    *, node: Node, include_hidden_topics: bool = False
) -> list[tuple[str, list[str]]]:
    """Return the topics of the graph, each with its types."""
    found = node.get_topic_names_and_types()
    return [
        (name, list(types))
        for name, types in found
        if include_hidden_topics or not topic_or_service_is_hidden(name)
    ]


def get_topic_names(*, node: Node, include_hidden_topics: bool = False) -> list[str]:
    """Return the names of the topics of the graph."""
    topics = get_topic_names_and_types(
        node=node, include_hidden_topics=include_hidden_topics
    )
    return [name for name, _ in topics]


def import_message_type(topic_name: str, message_type: str) -> Any:
    """Return the class of ``package/msg/Name``.

    Raises:
        RuntimeError: the name is wrong, or no message has it.
    """
    try:
        return get_message(message_type)
    except (AttributeError, LookupError, ValueError) as error:
        raise RuntimeError(
            f"topic {topic_name!r}: message type {message_type!r}: {error}"
        ) from error


def get_msg_class(
    node: Node, topic: str, blocking: bool = False, include_hidden_topics: bool = False
) -> Any:
    """Return the message class of a topic, or None while the topic has no endpoint.

    Args:
        blocking: wait for the first endpoint.

    Raises:
        RuntimeError: the topic has several types.
    """
    name = expand_topic_name(topic, node.get_name(), node.get_namespace())

    def types() -> list[str]:
        topics = dict(
            get_topic_names_and_types(
                node=node, include_hidden_topics=include_hidden_topics
            )
        )
        return topics.get(name, [])

    if blocking:
        rate = node.create_rate(10.0)
        while not types():
            rate.sleep()
        rate.destroy()
    found = types()
    if len(found) > 1:
        raise RuntimeError(f"topic {name!r} has several types: {', '.join(found)}")
    return import_message_type(name, found[0]) if found else None


def qos_profile_from_short_keys(
    preset_profile: str,
    reliability: str | None = None,
    durability: str | None = None,
    depth: int | None = None,
    history: str | None = None,
    liveliness: str | None = None,
    liveliness_lease_duration_s: float | None = None,
) -> QoSProfile:
    """Return a preset profile (``sensor_data``) with some policies replaced."""
    profile = QoSProfile(depth=1)
    preset = QoSPresetProfiles.get_from_short_key(preset_profile)
    for name in ("history", "depth", "reliability", "durability", "liveliness"):
        setattr(profile, name, getattr(preset, name))
    profile_configure_short_keys(
        profile,
        reliability,
        durability,
        depth,
        history,
        liveliness,
        liveliness_lease_duration_s,
    )
    return profile


def profile_configure_short_keys(
    profile: QoSProfile | None = None,
    reliability: str | None = None,
    durability: str | None = None,
    depth: int | None = None,
    history: str | None = None,
    liveliness: str | None = None,
    liveliness_lease_duration_s: float | None = None,
) -> None:
    """Replace the given policies of a profile, by their short words."""
    if profile is None:
        return
    for name, kind, word in (
        ("history", HistoryPolicy, history),
        ("durability", DurabilityPolicy, durability),
        ("reliability", ReliabilityPolicy, reliability),
        ("liveliness", LivelinessPolicy, liveliness),
    ):
        if word:
            setattr(profile, name, kind.get_from_short_key(word))
    if depth is not None and depth >= 0:
        profile.depth = depth
    elif profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and not profile.depth:
        profile.depth = 1
    if liveliness_lease_duration_s is not None and liveliness_lease_duration_s >= 0:
        profile.liveliness_lease_duration = Duration(
            seconds=liveliness_lease_duration_s
        )


class TopicNameCompleter:
    """Completion of topic names on a command line.

    Args:
        include_hidden_topics_key: argument that includes hidden topics.
    """

    def __init__(self, *, include_hidden_topics_key: str | None = None) -> None:
        self.include_hidden_topics_key = include_hidden_topics_key

    def __call__(self, prefix: str, parsed_args: Any, **kwargs: Any) -> Iterable[str]:
        key = self.include_hidden_topics_key
        with NodeStrategy(parsed_args) as tool:
            return get_topic_names(
                node=tool.node,
                include_hidden_topics=bool(key and getattr(parsed_args, key, False)),
            )
