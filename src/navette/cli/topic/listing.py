"""Topics with their publishers, subscriptions, types and QoS."""

import shutil
from dataclasses import dataclass
from typing import Any

from navette.cli.nearest import did_you_mean
from navette.cli.output import aligned, beside, is_terminal, styled
from navette.cli.session import endpoints, fail, is_hidden
from navette.runtime import Node
from navette.runtime.topic_endpoint_info import TopicEndpointInfo
from navette.transports import (
    INFINITE_NS,
    Endpoint,
    EndpointKind,
    EndpointQos,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    incompatible_policies,
)


@dataclass(frozen=True)
class TopicListing:
    """A topic and its endpoints."""

    name: str
    publishers: tuple[Endpoint, ...]
    subscriptions: tuple[Endpoint, ...]

    @property
    def types(self) -> list[str]:
        """Sorted type names; more than one if nodes accept several, or disagree."""
        every = (*self.publishers, *self.subscriptions)
        return sorted({endpoint.type_name for endpoint in every})

    @property
    def mismatches(self) -> list[str]:
        """Publisher and subscription pairs that do not match, each with the reason."""
        accepted = {(e.node_full_name, e.type_name) for e in self.subscriptions}
        return [
            _mismatch(publisher, subscription)
            for publisher in self.publishers
            for subscription in self.subscriptions
            if _mismatch(publisher, subscription)
            # A node that accepts several types has a subscription for each.
            and (
                publisher.type_name == subscription.type_name
                or (subscription.node_full_name, publisher.type_name) not in accepted
            )
        ]

    def to_json(self) -> dict[str, Any]:
        return {
            "name": self.name,
            "types": self.types,
            "publishers": [_endpoint_json(each) for each in self.publishers],
            "subscriptions": [_endpoint_json(each) for each in self.subscriptions],
            "mismatches": self.mismatches,
        }


def topics(node: Node, *, hidden: bool = False) -> list[TopicListing]:
    """Return all topics of other nodes, sorted by name."""
    by_name: dict[str, list[Endpoint]] = {}
    for endpoint in endpoints(node):
        by_name.setdefault(endpoint.topic, []).append(endpoint)
    names = sorted(name for name in by_name if hidden or not is_hidden(name))
    return [_topic(name, by_name[name]) for name in names]


def topic(node: Node, name: str) -> TopicListing:
    """Return the topic with this name; the command fails if there is none."""
    full_name = node.resolve_topic_name(name)
    found = endpoints(node, full_name)
    if not found:
        near = did_you_mean(full_name, (each.topic for each in endpoints(node)))
        fail(f"no publishers or subscriptions on {full_name}{near}")
    return _topic(full_name, found)


def listed(found: list[TopicListing], *, show_types: bool, verbose: bool) -> str:
    """Format a list: as ``ros2 topic list``, in columns on a terminal."""
    if verbose:
        return _table(found) if is_terminal() else _by_direction(found)
    if show_types:
        return _with_types(found)
    return "\n".join(each.name for each in found)


def described(found: TopicListing, *, verbose: bool) -> str:
    """Format one topic as ``ros2 topic info`` does, with its mismatches."""
    types = ", ".join(found.types)
    publishers, subscriptions = map(_nodes, (found.publishers, found.subscriptions))
    blocks = [
        f"Type: {types}",
        f"Publisher count: {len(found.publishers)}{publishers}",
    ]
    if verbose:
        blocks += [str(TopicEndpointInfo.of(each)) for each in found.publishers]
    blocks.append(f"Subscription count: {len(found.subscriptions)}{subscriptions}")
    if verbose:
        blocks += [str(TopicEndpointInfo.of(each)) for each in found.subscriptions]
    blocks += [styled(f"Mismatch: {text}", fg="red") for text in found.mismatches]
    return ("\n\n" if verbose else "\n").join(blocks)


def _nodes(found: tuple[Endpoint, ...]) -> str:
    """Return the names of the nodes, on a terminal only."""
    names = sorted({each.node_full_name for each in found})
    if not is_terminal() or not names:
        return ""
    return styled(f"  {', '.join(names)}", dim=True)


def describe_qos(qos: EndpointQos) -> str:
    """Summarize a QoS profile: ``reliable, volatile, last 10``."""
    kept = "all" if qos.history == HistoryPolicy.KEEP_ALL else f"last {qos.depth}"
    words = [qos.reliability.short_key, qos.durability.short_key, kept]
    if qos.deadline_ns != INFINITE_NS:
        words.append(f"deadline {qos.deadline_ns / 1e9:g} s")
    if qos.liveliness == LivelinessPolicy.MANUAL_BY_TOPIC:
        words.append("manual liveliness")
    return ", ".join(words)


def _topic(name: str, found: list[Endpoint]) -> TopicListing:
    publishers = [e for e in found if e.kind == EndpointKind.PUBLISHER]
    subscriptions = [e for e in found if e.kind == EndpointKind.SUBSCRIPTION]
    return TopicListing(name, tuple(publishers), tuple(subscriptions))


def _with_types(found: list[TopicListing]) -> str:
    if not is_terminal():
        return "\n".join(f"{each.name} [{', '.join(each.types)}]" for each in found)
    return "\n".join(beside((each.name, ", ".join(each.types)) for each in found))


def _by_direction(found: list[TopicListing]) -> str:
    sections = (
        ("Published topics:", "publisher", [each.publishers for each in found]),
        ("Subscribed topics:", "subscriber", [each.subscriptions for each in found]),
    )
    lines = []
    for title, word, groups in sections:
        lines.append(title)
        for each, group in zip(found, groups, strict=True):
            if group:
                types = ", ".join(each.types)
                lines.append(f" * {each.name} [{types}] {_count(len(group), word)}")
        lines.append("")
    return "\n".join(lines)


def _table(found: list[TopicListing]) -> str:
    head = ("TOPIC", "TYPE", "PUB", "SUB", "QOS OF THE PUBLISHERS")
    rows = [
        (
            each.name,
            ", ".join(each.types),
            str(len(each.publishers)),
            str(len(each.subscriptions)),
            "; ".join(sorted({describe_qos(e.qos) for e in each.publishers})),
        )
        for each in found
    ]
    first, *lines = aligned([head, *rows])
    if max(map(len, (first, *lines))) > shutil.get_terminal_size().columns:
        lines = [line for row in rows for line in _stacked(*row)]
    else:
        lines.insert(0, styled(first, dim=True))
    for each in found:
        lines += [styled(f"{each.name}: {text}", fg="red") for text in each.mismatches]
    return "\n".join(lines)


def _stacked(name: str, types: str, pubs: str, subs: str, qos: str) -> list[str]:
    """Format a topic in several lines, for terminals too narrow for a table."""
    counts = f"{_count(int(pubs), 'publisher')}, {_count(int(subs), 'subscription')}"
    details = [types, counts, *([qos] if qos else [])]
    return [name, *(f"    {styled(each, dim=True)}" for each in details)]


def _count(number: int, word: str) -> str:
    return f"{number} {word}" + ("" if number == 1 else "s")


def _mismatch(publisher: Endpoint, subscription: Endpoint) -> str:
    pair = f"{publisher.node_full_name} → {subscription.node_full_name}"
    if publisher.type_name != subscription.type_name:
        return f"{pair}: {publisher.type_name} is not {subscription.type_name}"
    short = incompatible_policies(publisher.qos, subscription.qos)
    reasons = [_reason(kind, publisher.qos, subscription.qos) for kind in short]
    return f"{pair}: {', '.join(reasons)}" if reasons else ""


def _reason(kind: QoSPolicyKind, offered: EndpointQos, wanted: EndpointQos) -> str:
    word = kind.name.lower()
    mine, other = getattr(offered, word, None), getattr(wanted, word, None)
    if mine is None or other is None:
        return word.replace("_", " ")
    return f"{word} {other.short_key} requested, {mine.short_key} offered"


def _endpoint_json(endpoint: Endpoint) -> dict[str, Any]:
    info = TopicEndpointInfo.of(endpoint)
    qos = endpoint.qos
    return {
        "node": endpoint.node_full_name,
        "type": endpoint.type_name,
        "hash": str(info.topic_type_hash),
        "gid": endpoint.gid.hex(),
        "qos": {
            "history": qos.history.short_key,
            "depth": qos.depth,
            "reliability": qos.reliability.short_key,
            "durability": qos.durability.short_key,
            "deadline_ns": None if qos.deadline_ns == INFINITE_NS else qos.deadline_ns,
            "lifespan_ns": None if qos.lifespan_ns == INFINITE_NS else qos.lifespan_ns,
            "liveliness": qos.liveliness.short_key,
            "lease_ns": None if qos.lease_ns == INFINITE_NS else qos.lease_ns,
        },
    }
