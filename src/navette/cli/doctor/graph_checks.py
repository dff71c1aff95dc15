"""Check nodes, topics and services of the graph."""

from collections import Counter
from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from itertools import product

from navette.cli.doctor.chain import consequence, explained, missing_links
from navette.cli.doctor.findings import TOPICS, Diagnosis, Rating, listed, plural
from navette.cli.doctor.snapshot import Snapshot, is_own
from navette.cli.doctor.topic_types import type_problems
from navette.cli.session import is_of_every_node
from navette.msgs.topics import OPTIONAL
from navette.transports import Endpoint, EndpointKind, QoSPolicyKind
from navette.transports.qos import incompatible_policies

NODES = "Nodes"
SERVICES = "Services"

# A missing publisher is normal.
_OPTIONAL = {*(topic.name for topic in OPTIONAL), "/clicked_point"}
# Similarity of a misspelled name (difflib's ratio).
_LIKE = 0.8

_REMEDIES = {
    QoSPolicyKind.RELIABILITY: "make the subscription best effort"
    " (qos_profile_sensor_data) or the publisher reliable",
    QoSPolicyKind.DURABILITY: "make the publisher transient local (latched) or the"
    " subscription volatile",
    QoSPolicyKind.DEADLINE: "give the subscription a longer deadline",
    QoSPolicyKind.LIVELINESS: "make the liveliness of the subscription automatic",
    QoSPolicyKind.LIVELINESS_LEASE_DURATION: "give the subscription a longer lease",
}


def check_nodes(seen: Snapshot) -> Iterator[Diagnosis]:
    """Check that nodes have unique names and respond, and that no stage is missing."""
    for name in seen.unreached:
        topics = seen.unreached_topics.get(name, ())
        how = "is listed by the router, but cannot be reached"
        yield _silent(name, how + consequence(seen, topics), topics)
    yield from _missing_stages(seen)
    if not seen.nodes:
        yield Diagnosis(
            Rating.NOTE,
            NODES,
            "nodes",
            "none",
            "start a program (navette demo) in a terminal with the same"
            " ROS_DOMAIN_ID and NAVETTE_ROUTER as this one",
        )
        return
    problems = [*_nodes_named_twice(seen), *_silent_nodes(seen)]
    yield from problems or [_healthy_nodes(seen)]


def _missing_stages(seen: Snapshot) -> Iterator[Diagnosis]:
    for link in missing_links(seen):
        yield Diagnosis(
            Rating.PROBLEM,
            NODES,
            link.stage,
            f"is missing: no node turns {link.reads.name} into {link.publishes.name}"
            + consequence(seen, [link.publishes.name]),
            "it ended, was never started, or is disconnected: check navette ps, or"
            f" start it with navette run navette {link.stage}",
            {
                "missing": link.stage,
                "reads": link.reads.name,
                "makes": link.publishes.name,
            },
        )


def _nodes_named_twice(seen: Snapshot) -> Iterator[Diagnosis]:
    counts = Counter(seen.nodes)
    for name in sorted(name for name, times in counts.items() if times > 1):
        yield Diagnosis(
            Rating.PROBLEM,
            NODES,
            name,
            f"{counts[name]} nodes have this name",
            "a program was started twice (navette ps --all), or one needs another"
            " name: --ros-args -r __node:=NAME",
        )


def _silent_nodes(seen: Snapshot) -> Iterator[Diagnosis]:
    for name in sorted(name for name, time in seen.sim_time.items() if time is None):
        makes = seen.published_by(name)
        yield _silent(name, "does not respond" + consequence(seen, makes), makes)


def _healthy_nodes(seen: Snapshot) -> Diagnosis:
    several = len(seen.nodes) > 1
    text = plural(len(seen.nodes), "node")
    text += " with unique names" if several else ""
    text += f"; {'all respond' if several else 'it responds'}" if seen.sim_time else ""
    return Diagnosis(
        Rating.GOOD, NODES, "nodes", text, data={"nodes": sorted(seen.nodes)}
    )


def _silent(name: str, how: str, topics: Iterable[str]) -> Diagnosis:
    advice = "its program is stopped (Ctrl-Z), hangs in a callback, or is disconnected"
    data = {"silent": name, "publishes": sorted(topics)}
    return Diagnosis(Rating.PROBLEM, NODES, name, how, advice, data)


def check_topics(seen: Snapshot) -> Iterator[Diagnosis]:
    """Check types and QoS of each topic, and report topics without a publisher."""
    problems = [
        finding
        for topic in seen.topics
        for finding in (*type_problems(seen, topic), *_qos_problems(seen, topic))
    ]
    yield from problems
    joined = [t for t in seen.topics if seen.publishers(t) and seen.subscriptions(t)]
    if joined and not problems:
        text = f"{plural(len(joined), 'topic')} connected, types and QoS match"
        yield Diagnosis(Rating.GOOD, TOPICS, "topics", text, data={"topics": joined})
    yield from _unconnected(seen)


def _qos_problems(seen: Snapshot, topic: str) -> Iterator[Diagnosis]:
    for publisher, subscription in product(
        seen.publishers(topic), seen.subscriptions(topic)
    ):
        if publisher.type_name != subscription.type_name:
            continue
        short = incompatible_policies(publisher.qos, subscription.qos)
        if short:
            yield Diagnosis(
                Rating.PROBLEM,
                TOPICS,
                topic,
                f"{subscription.node_full_name} receives nothing from"
                f" {publisher.node_full_name}: incompatible {_policies(short)}",
                "; ".join(_REMEDIES[kind] for kind in short),
            )


def _policies(kinds: tuple[QoSPolicyKind, ...]) -> str:
    return ", ".join(kind.name.lower().replace("_", " ") for kind in kinds)


def _unconnected(seen: Snapshot) -> Iterator[Diagnosis]:
    """Report topics with only one side, often caused by a mistyped name."""
    unread = [t for t in seen.topics if not seen.subscriptions(t)]
    known = explained(seen)
    unpublished = [t for t in seen.topics if not seen.publishers(t) and t not in known]
    for topic in unpublished:
        wanted = seen.subscriptions(topic)[0]
        instead = [t for t in unread if _has_type(seen, t, wanted.type_name)]
        if topic in _OPTIONAL:
            instead = get_close_matches(topic, instead, cutoff=_LIKE)
            if not instead:
                continue
        yield _unpublished(seen, wanted, instead)
    if unread:
        yield Diagnosis(
            Rating.NOTE,
            TOPICS,
            "unread",
            listed(unread),
            data={"topics": unread},
        )


def _has_type(seen: Snapshot, topic: str, type_name: str) -> bool:
    return any(e.type_name == type_name for e in seen.publishers(topic))


def _unpublished(seen: Snapshot, wanted: Endpoint, instead: list[str]) -> Diagnosis:
    topic = wanted.topic
    readers = {e.node_full_name for e in seen.subscriptions(topic)}
    advice = "start its publisher, or check the spelling of the name"
    if instead:
        advice = (
            f"{listed(instead)} has the same type and no subscription; to use it:"
            f" --ros-args -r {topic}:={instead[0]}"
        )
    return Diagnosis(
        Rating.WARNING,
        TOPICS,
        topic,
        f"has no publisher; {listed(readers)} "
        f"{'waits' if len(readers) == 1 else 'wait'} for it",
        advice,
        {"type": wanted.type_name, "published_instead": instead},
    )


def check_services(seen: Snapshot) -> Iterator[Diagnosis]:
    """Check that every client has a server with the same type."""
    every = [
        e for e in seen.services if not (is_own(e.topic) or is_of_every_node(e.topic))
    ]
    names = sorted({e.topic for e in every})
    served = Counter(e.topic for e in every if e.kind is EndpointKind.SERVICE)
    for name in names:
        clients = [e for e in every if e.topic == name]
        types = {e.type_name for e in clients}
        if len(types) > 1:
            yield Diagnosis(
                Rating.PROBLEM,
                SERVICES,
                name,
                f"has {len(types)} types: {listed(types)}",
                "the client and the server need the same type",
            )
        elif not served[name]:
            yield Diagnosis(
                Rating.WARNING,
                SERVICES,
                name,
                f"has no server; {listed({e.node_full_name for e in clients})}"
                " may wait for it",
                "start its server, or check the spelling of the name",
            )
