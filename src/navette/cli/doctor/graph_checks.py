"""Checks of the graph: who is there, and does what is said reach those who listen?"""

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import product

from navette.cli.doctor.chain import consequence, explained, missing_links
from navette.cli.doctor.findings import Finding, Level, listed, plural
from navette.cli.doctor.snapshot import Snapshot, is_own
from navette.cli.session import is_of_every_node
from navette.topics import GOAL_POINT, GOAL_POSE, INITIAL_POSE
from navette.transports import Endpoint, EndpointKind, QoSPolicyKind
from navette.transports.qos import incompatible_policies

NODES = "Nodes"
TOPICS = "Topics"
SERVICES = "Services"

# What a person publishes, by a click or a command: silence is normal.
_BY_HAND = {
    GOAL_POINT.name,
    GOAL_POSE.name,
    INITIAL_POSE.name,
    "/clicked_point",
}

_MENDS = {
    QoSPolicyKind.RELIABILITY: "let the subscription ask for best effort"
    " (qos_profile_sensor_data), or the publisher offer reliable",
    QoSPolicyKind.DURABILITY: "let the publisher be transient local (latched), or the"
    " subscription volatile",
    QoSPolicyKind.DEADLINE: "give the subscription a longer deadline",
    QoSPolicyKind.LIVELINESS: "let the subscription ask for automatic liveliness",
    QoSPolicyKind.LIVELINESS_LEASE_DURATION: "give the subscription a longer lease",
}


def check_nodes(seen: Snapshot) -> Iterator[Finding]:
    """Are there nodes, under names of their own, and do they answer?"""
    for name in seen.unreached:
        topics = seen.unreached_topics.get(name, ())
        how = "is known to the router, but cannot be reached"
        yield _silent(name, how + consequence(seen, topics), topics)
    for link in missing_links(seen):
        yield Finding(
            Level.PROBLEM,
            NODES,
            link.stage,
            f"is missing: no node turns {link.reads.name} into {link.publishes.name}"
            + consequence(seen, [link.publishes.name]),
            "it has ended, is cut off, or was never started: navette ps;"
            f" navette run navette {link.stage}",
            {
                "missing": link.stage,
                "reads": link.reads.name,
                "makes": link.publishes.name,
            },
        )
    if not seen.nodes:
        yield Finding(
            Level.NOTE,
            NODES,
            "nodes",
            "none is there",
            "start something (navette demo), in a terminal with the same"
            " ROS_DOMAIN_ID and NAVETTE_ROUTER as this one",
        )
        return
    twice = sorted(name for name, times in Counter(seen.nodes).items() if times > 1)
    for name in twice:
        yield Finding(
            Level.PROBLEM,
            NODES,
            name,
            f"{seen.nodes.count(name)} nodes have this name",
            "a program was started twice (navette ps --all), or two need names of"
            " their own: --ros-args -r __node:=NAME",
        )
    silent = sorted(name for name, answer in seen.sim_time.items() if answer is None)
    for name in silent:
        makes = seen.published_by(name)
        how = "is there, but does not answer"
        yield _silent(name, how + consequence(seen, makes), makes)
    if not twice and not silent:
        several = len(seen.nodes) > 1
        text = plural(len(seen.nodes), "node")
        text += ", each with a name of its own" if several else ""
        text += (
            f"; {'all answer' if several else 'it answers'}" if seen.sim_time else ""
        )
        yield Finding(
            Level.GOOD, NODES, "nodes", text, data={"nodes": sorted(seen.nodes)}
        )


def _silent(name: str, how: str, topics: Iterable[str]) -> Finding:
    advice = "its program is stopped (Ctrl-Z), hangs in a callback, or is cut off"
    data = {"silent": name, "publishes": sorted(topics)}
    return Finding(Level.PROBLEM, NODES, name, how, advice, data)


def check_topics(seen: Snapshot) -> Iterator[Finding]:
    """Do publishers and subscriptions of each topic fit, and find each other?"""
    troubles = [
        finding
        for topic in seen.topics
        for finding in (*_type_trouble(seen, topic), *_qos_trouble(seen, topic))
    ]
    yield from troubles
    joined = [t for t in seen.topics if seen.publishers(t) and seen.subscriptions(t)]
    if joined and not troubles:
        text = f"{plural(len(joined), 'topic')} with both sides, all fit"
        yield Finding(Level.GOOD, TOPICS, "topics", text, data={"topics": joined})
    yield from _lonely(seen)


def _type_trouble(seen: Snapshot, topic: str) -> Iterator[Finding]:
    ends = [*seen.publishers(topic), *seen.subscriptions(topic)]
    types: dict[str, set[str]] = {}
    for end in ends:
        types.setdefault(end.type_name, set()).add(end.node_full_name)
    if len(types) > 1:
        who = "; ".join(f"{name}: {listed(types[name])}" for name in sorted(types))
        yield Finding(
            Level.PROBLEM,
            TOPICS,
            topic,
            f"has {len(types)} types: {who}",
            "they do not hear each other; give one of them another topic, or the"
            " same type",
        )
        return
    # Of nodes in this process nothing is known; before Jazzy there was a word instead.
    hashed = [e for e in ends if e.type_hash.startswith("RIHS")]
    versions: dict[str, set[str]] = {}
    for end in hashed:
        versions.setdefault(end.type_hash, set()).add(end.node_full_name)
    if len(versions) > 1:
        who = " | ".join(sorted(listed(names) for names in versions.values()))
        yield Finding(
            Level.PROBLEM,
            TOPICS,
            topic,
            f"{next(iter(types))} has {len(versions)} definitions: {who}",
            "they do not hear each other: install the same version of its package"
            " on both sides",
            {"hashes": {each: sorted(names) for each, names in versions.items()}},
        )


def _qos_trouble(seen: Snapshot, topic: str) -> Iterator[Finding]:
    for publisher, subscription in product(
        seen.publishers(topic), seen.subscriptions(topic)
    ):
        if publisher.type_name != subscription.type_name:
            continue
        short = incompatible_policies(publisher.qos, subscription.qos)
        if short:
            yield Finding(
                Level.PROBLEM,
                TOPICS,
                topic,
                f"{subscription.node_full_name} gets nothing from"
                f" {publisher.node_full_name}: {_policies(short)} of less than it"
                " asks for",
                "; ".join(_MENDS[kind] for kind in short),
            )


def _policies(kinds: tuple[QoSPolicyKind, ...]) -> str:
    return ", ".join(kind.name.lower().replace("_", " ") for kind in kinds)


def _lonely(seen: Snapshot) -> Iterator[Finding]:
    """Topics with one side only: a wrong name shows here."""
    unread = [t for t in seen.topics if not seen.subscriptions(t)]
    known = _BY_HAND | explained(seen)
    unsaid = [t for t in seen.topics if not seen.publishers(t) and t not in known]
    for topic in unsaid:
        wanted = seen.subscriptions(topic)[0]
        yield _unsaid(seen, wanted, [t for t in unread if _is_of(seen, t, wanted)])
    if unread:
        yield Finding(
            Level.NOTE,
            TOPICS,
            "nobody reads",
            listed(unread),
            data={"topics": unread},
        )


def _is_of(seen: Snapshot, topic: str, wanted: Endpoint) -> bool:
    return any(e.type_name == wanted.type_name for e in seen.publishers(topic))


def _unsaid(seen: Snapshot, wanted: Endpoint, instead: list[str]) -> Finding:
    topic = wanted.topic
    readers = {e.node_full_name for e in seen.subscriptions(topic)}
    advice = "start what publishes it, or look for a mistyped name"
    if instead:
        advice = (
            f"nobody reads {listed(instead)}, of the same type: if that is meant,"
            f" --ros-args -r {topic}:={instead[0]}"
        )
    return Finding(
        Level.WARNING,
        TOPICS,
        topic,
        f"nobody publishes it; {listed(readers)} "
        f"{'waits' if len(readers) == 1 else 'wait'} for it",
        advice,
        {"type": wanted.type_name, "published_instead": instead},
    )


def check_services(seen: Snapshot) -> Iterator[Finding]:
    """Is there a server for every client, and one only?"""
    every = [
        e for e in seen.services if not (is_own(e.topic) or is_of_every_node(e.topic))
    ]
    names = sorted({e.topic for e in every})
    served = Counter(e.topic for e in every if e.kind is EndpointKind.SERVICE)
    for name in names:
        clients = [e for e in every if e.topic == name]
        types = {e.type_name for e in clients}
        if len(types) > 1:
            yield Finding(
                Level.PROBLEM,
                SERVICES,
                name,
                f"has {len(types)} types: {listed(types)}",
                "the client and the server need the same type",
            )
        elif not served[name]:
            yield Finding(
                Level.WARNING,
                SERVICES,
                name,
                f"nobody serves it; {listed({e.node_full_name for e in clients})}"
                " may wait for it",
                "start its server, or look for a mistyped name",
            )
