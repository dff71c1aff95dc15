"""Check that the nodes of a topic use the same type and definition."""

from collections.abc import Iterable, Iterator
from itertools import combinations, product

from navette.cli.doctor.distributions import distros_by_hash
from navette.cli.doctor.findings import TOPICS, Diagnosis, Rating, listed
from navette.cli.doctor.snapshot import Snapshot
from navette.msgs.registry import DISTRO_VARIABLE
from navette.transports import Endpoint


def type_problems(seen: Snapshot, topic: str) -> Iterator[Diagnosis]:
    """Report nodes that cannot communicate: another type, or another definition.

    A node may use several types on one topic, such as Twist and TwistStamped; nodes
    communicate if they have one in common.
    """
    publishers = _types_by_node(seen.publishers(topic))
    subscribers = _types_by_node(seen.subscriptions(topic))
    if publishers and subscribers:
        pairs = list(product(publishers.values(), subscribers.values()))
    else:
        pairs = list(combinations((publishers or subscribers).values(), 2))
    ends = [*seen.publishers(topic), *seen.subscriptions(topic)]
    nodes = _nodes_by_type(ends)
    if any(one.isdisjoint(other) for one, other in pairs):
        who = "; ".join(f"{name}: {listed(nodes[name])}" for name in sorted(nodes))
        yield Diagnosis(
            Rating.PROBLEM,
            TOPICS,
            topic,
            f"has {len(nodes)} types: {who}",
            "they cannot communicate: rename one topic, or use the same type",
        )
        return
    for type_name in sorted(nodes):
        same = [e for e in ends if e.type_name == type_name]
        yield from _definition_problem(topic, type_name, same)


def _types_by_node(ends: Iterable[Endpoint]) -> dict[str, set[str]]:
    types: dict[str, set[str]] = {}
    for end in ends:
        types.setdefault(end.node_full_name, set()).add(end.type_name)
    return types


def _nodes_by_type(ends: Iterable[Endpoint]) -> dict[str, set[str]]:
    nodes: dict[str, set[str]] = {}
    for end in ends:
        nodes.setdefault(end.type_name, set()).add(end.node_full_name)
    return nodes


def _definition_problem(
    topic: str, type_name: str, ends: Iterable[Endpoint]
) -> Iterator[Diagnosis]:
    # Nodes of this process have no hash; before Jazzy it was a placeholder.
    hashed = [e for e in ends if e.type_hash.startswith("RIHS")]
    versions: dict[str, set[str]] = {}
    for end in hashed:
        versions.setdefault(end.type_hash, set()).add(end.node_full_name)
    if len(versions) < 2:
        return
    of_hash = distros_by_hash(type_name)
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
        f"{type_name} has {len(versions)} definitions: {who}",
        "they cannot communicate: install the same version of its package"
        f" on both sides, or start Navette with {DISTRO_VARIABLE}=NAME",
        {"hashes": {each: sorted(names) for each, names in versions.items()}},
    )


def _definition(distros: dict[str, list[str]], type_hash: str) -> str:
    """Return the start of a hash, and the distributions of ROS 2 that it belongs to."""
    known = ", ".join(distros.get(type_hash, ()))
    start = type_hash.removeprefix("RIHS01_")[:8]
    return f"{known or 'of no known distribution'}, hash {start}…"
