"""Check nodes, topics and services of the graph."""

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import product

from navette.cli.doctor.chain import consequence, explained, missing_links
from navette.cli.doctor.distributions import distros_by_hash
from navette.cli.doctor.findings import Diagnosis, Rating, listed, plural
from navette.cli.doctor.snapshot import Snapshot, is_own
from navette.cli.session import is_of_every_node
from navette.msgs.registry import DISTRO_VARIABLE
from navette.msgs.topics import GOAL_POINT, GOAL_POSE, INITIAL_POSE
from navette.transports import Endpoint, EndpointKind, QoSPolicyKind
from navette.transports.qos import incompatible_policies

NODES = "Nodes"
TOPICS = "Topics"
SERVICES = "Services"

# Published by hand: a missing publisher is normal.
_BY_HAND = {
    GOAL_POINT.name,
    GOAL_POSE.name,
    INITIAL_POSE.name,
    "/clicked_point",
}

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
        for finding in (*_type_problems(seen, topic), *_qos_problems(seen, topic))
    ]
    yield from problems
    joined = [t for t in seen.topics if seen.publishers(t) and seen.subscriptions(t)]
    if joined and not problems:
        text = f"{plural(len(joined), 'topic')} connected, types and QoS match"
        yield Diagnosis(Rating.GOOD, TOPICS, "topics", text, data={"topics": joined})
    yield from _unconnected(seen)


def _type_problems(seen: Snapshot, topic: str) -> Iterator[Diagnosis]:
    ends = [*seen.publishers(topic), *seen.subscriptions(topic)]
    types: dict[str, set[str]] = {}
    for end in ends:
        types.setdefault(end.type_name, set()).add(end.node_full_name)
    if len(types) > 1:
        who = "; ".join(f"{name}: {listed(types[name])}" for name in sorted(types))
        yield Diagnosis(
            Rating.PROBLEM,
            TOPICS,
            topic,
            f"has {len(types)} types: {who}",
            "they cannot communicate: rename one topic, or use the same type",
        )
        return
    # Nodes of this process have no hash; before Jazzy it was a placeholder.
    hashed = [e for e in ends if e.type_hash.startswith("RIHS")]
    versions: dict[str, set[str]] = {}
    for end in hashed:
        versions.setdefault(end.type_hash, set()).add(end.node_full_name)
    if len(versions) > 1:
        of_hash = distros_by_hash(next(iter(types)))
        who = " | ".join(
            sorted(
                f"{listed(names)} ({_definition(of_hash, each)})"
                for each, names in versions.items()
            )
        )
        yield Diagnosis(
            Rating.PROBLEM,
            TOPICS,
            topic,
            f"{next(iter(types))} has {len(versions)} definitions: {who}",
            "they cannot communicate: install the same version of its package"
            f" on both sides, or start Navette with {DISTRO_VARIABLE}=NAME",
            {"hashes": {each: sorted(names) for each, names in versions.items()}},
        )


def _definition(distros: dict[str, list[str]], type_hash: str) -> str:
    """Return the start of a hash, and the distributions of ROS 2 that it belongs to."""
    known = ", ".join(distros.get(type_hash, ()))
    start = type_hash.removeprefix("RIHS01_")[:8]
    return f"{known or 'of no known distribution'}, hash {start}…"


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
    known = _BY_HAND | explained(seen)
    unpublished = [t for t in seen.topics if not seen.publishers(t) and t not in known]
    for topic in unpublished:
        wanted = seen.subscriptions(topic)[0]
        instead = [t for t in unread if _has_type(seen, t, wanted.type_name)]
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
