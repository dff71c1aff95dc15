"""Graph of nodes, topics and endpoints, with callbacks for changes."""

import itertools
import threading
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import replace
from typing import Generic, ParamSpec

from navette.transports import (
    Endpoint,
    EndpointKind,
    NodeInfo,
    QoSPolicyKind,
    Transport,
    TransportObserver,
)

P = ParamSpec("P")


class GraphEvent(Generic[P]):
    """An event of the graph; calling it registers a callback.

    Callbacks run during the change and must not modify the graph.
    """

    def __init__(self) -> None:
        self._callbacks: list[Callable[P, object]] = []

    def __call__(self, callback: Callable[P, object]) -> Callable[[], None]:
        """Register a callback; return a function that removes it, once."""
        self._callbacks.append(callback)

        def remove() -> None:
            # Two threads may close the same endpoint: the program's and the end's.
            with suppress(ValueError):
                self._callbacks.remove(callback)

        return remove

    def report(self, *args: P.args, **kwargs: P.kwargs) -> None:
        """Run the callbacks."""
        for callback in tuple(self._callbacks):
            callback(*args, **kwargs)


class TopicEvent(Generic[P]):
    """An event at one topic; calling it registers a callback for a topic.

    With thousands of topics, a change at one concerns few endpoints.
    """

    def __init__(self) -> None:
        self._events: dict[str, GraphEvent[P]] = {}

    def __call__(self, topic: str, callback: Callable[P, object]) -> Callable[[], None]:
        """Register a callback; return a function that removes it, once."""
        return self._events.setdefault(topic, GraphEvent())(callback)

    def report(self, topic: str, *args: P.args, **kwargs: P.kwargs) -> None:
        """Run the callbacks of the topic."""
        event = self._events.get(topic)
        if event is not None:
            event.report(*args, **kwargs)


class Graph(TransportObserver):
    """Nodes and endpoints that the context's transports have discovered."""

    def __init__(self) -> None:
        self.transports: list[Transport] = []
        #: Held while transports are selected.
        self.joining = threading.Lock()
        self._nodes: list[NodeInfo] = []
        #: A node or endpoint was added or removed.
        self.on_change = GraphEvent[[]]()
        #: A publisher and a subscription matched (True) or stopped matching (False).
        self.on_match = TopicEvent[[Endpoint, Endpoint, bool]]()
        #: A publisher and a subscription do not match, because of these policies.
        self.on_incompatible = TopicEvent[
            [Endpoint, Endpoint, tuple[QoSPolicyKind, ...]]
        ]()
        #: A local endpoint and a remote endpoint of its topic differ in type.
        self.on_incompatible_type = TopicEvent[[Endpoint, Endpoint]]()
        #: A local subscription lost this number of samples.
        self.on_lost = TopicEvent[[Endpoint, int]]()
        #: A publisher's lease was renewed (True) or has expired (False).
        self.on_liveliness = GraphEvent[[Endpoint, bool]]()
        #: A remote publisher asserted its liveliness to a local subscription.
        self.on_assertion = TopicEvent[[Endpoint, Endpoint]]()
        #: Gids of the publishers with manual liveliness and a valid lease.
        self.manually_alive: set[bytes] = set()
        self._gids = itertools.count(1)

    def add_transport(self, transport: Transport) -> None:
        """Add a transport, on which all future endpoints open a port."""
        self.transports.append(transport)
        transport.observe(self)

    def close(self) -> None:
        """Close the transports."""
        for transport in self.transports:
            transport.close()

    def add_node(self, info: NodeInfo) -> None:
        self._nodes.append(info)
        for transport in self.transports:
            transport.announce(info)
        self.graph_changed()

    def remove_node(self, info: NodeInfo) -> None:
        if info in self._nodes:
            self._nodes.remove(info)
            for transport in self.transports:
                transport.withdraw(info)
            self.graph_changed()

    def with_gid(self, endpoint: Endpoint) -> Endpoint:
        """Return the endpoint with its 16-byte gid, also used by remote endpoints.

        Without a network transport, every run assigns the same gids in the same order.
        """
        for transport in self.transports:
            gid = transport.gid_for(endpoint)
            if gid is not None:
                return replace(endpoint, gid=gid)
        # next() is one step, also where several threads share the graph.
        return replace(endpoint, gid=next(self._gids).to_bytes(16, "big"))

    def graph_changed(self) -> None:
        self.on_change.report()

    def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        self.on_match.report(publisher.topic, publisher, subscription, True)

    def unmatched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        self.on_match.report(publisher.topic, publisher, subscription, False)

    def asserted(self, publisher: Endpoint, subscription: Endpoint) -> None:
        self.on_assertion.report(publisher.topic, publisher, subscription)

    def report_liveliness(self, publisher: Endpoint, *, alive: bool) -> None:
        """Record and report that a publisher's lease was renewed or has expired."""
        if alive:
            self.manually_alive.add(publisher.gid)
        else:
            self.manually_alive.discard(publisher.gid)
        self.on_liveliness.report(publisher, alive)

    def incompatible_qos(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> None:
        self.on_incompatible.report(publisher.topic, publisher, subscription, policies)

    def message_lost(self, subscription: Endpoint, count: int) -> None:
        self.on_lost.report(subscription.topic, subscription, count)

    def incompatible_type(self, local: Endpoint, remote: Endpoint) -> None:
        self.on_incompatible_type.report(local.topic, local, remote)

    def nodes(self) -> list[NodeInfo]:
        """Return local nodes, then remote nodes; equal names are listed repeatedly."""
        remote = (info for t in self.transports for info in t.remote_nodes())
        return [*self._nodes, *remote]

    def endpoints(
        self,
        topic: str | None = None,
        *,
        kind: EndpointKind | None = None,
        node: str | None = None,
    ) -> list[Endpoint]:
        """Return the matching endpoints of topics, sorted by topic and gid.

        Args:
            topic: full name.
            node: full name.
        """
        every = (e for t in self.transports for e in t.endpoints(topic))
        return _selected(every, topic, kind, node)

    def count(self, topic: str, kind: EndpointKind) -> int:
        """Return the number of publishers or subscriptions of a topic (full name)."""
        every = [e for t in self.transports for e in t.endpoints(topic)]
        return sum(e.kind == kind and e.topic == topic for e in every)

    def service_endpoints(
        self,
        service: str | None = None,
        *,
        kind: EndpointKind | None = None,
        node: str | None = None,
    ) -> list[Endpoint]:
        """Return the matching servers and clients, sorted by service and gid."""
        every = (e for t in self.transports for e in t.service_endpoints())
        return _selected(every, service, kind, node)

    def topics(self) -> dict[str, list[str]]:
        """Return full topic name → type names, sorted by name."""
        return names_and_types(e for t in self.transports for e in t.endpoints())

    def services(self) -> dict[str, list[str]]:
        """Return full name of each served service → type names, sorted by name."""
        return names_and_types(self.service_endpoints(kind=EndpointKind.SERVICE))


def _selected(
    endpoints: Iterable[Endpoint],
    name: str | None,
    kind: EndpointKind | None,
    node: str | None,
) -> list[Endpoint]:
    found = [
        endpoint
        for endpoint in endpoints
        if (name is None or endpoint.topic == name)
        and (kind is None or endpoint.kind == kind)
        and (node is None or endpoint.node_full_name == node)
    ]
    return sorted(found, key=lambda endpoint: (endpoint.topic, endpoint.gid))


def names_and_types(endpoints: Iterable[Endpoint]) -> dict[str, list[str]]:
    """Return topic → sorted type names of the endpoints."""
    found: dict[str, set[str]] = {}
    for endpoint in endpoints:
        found.setdefault(endpoint.topic, set()).add(endpoint.type_name)
    return {topic: sorted(found[topic]) for topic in sorted(found)}
