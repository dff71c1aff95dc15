"""Who is there: nodes, topics, endpoints; with a hook for viewers and recorders."""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from navette.transports import (
    Endpoint,
    EndpointKind,
    QoSPolicyKind,
    Transport,
    TransportObserver,
)

IncompatibleHook = Callable[[Endpoint, Endpoint, tuple[QoSPolicyKind, ...]], None]


@dataclass(frozen=True)
class NodeInfo:
    """A node as the graph lists it."""

    name: str
    namespace: str
    enclave: str = "/"

    @property
    def full_name(self) -> str:
        return f"{self.namespace.rstrip('/')}/{self.name}"


class Graph(TransportObserver):
    """Everything that the context's transports can see."""

    def __init__(self) -> None:
        self.transports: list[Transport] = []
        self._nodes: list[NodeInfo] = []
        self._on_change: list[Callable[[], None]] = []
        self._on_incompatible: list[IncompatibleHook] = []
        self._on_match: list[Callable[[Endpoint, Endpoint, bool], None]] = []
        self._on_liveliness: list[Callable[[Endpoint, bool], None]] = []
        #: Gids of the publishers that assert themselves and whose lease holds.
        self.manually_alive: set[bytes] = set()
        self._gids = itertools.count(1)

    # -- hooks -----------------------------------------------------------------

    def on_change(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call back after any node or endpoint came or went; returns an undo.

        The callback is called from within the change: look, do not alter the graph.
        """
        self._on_change.append(callback)
        return lambda: self._on_change.remove(callback)

    def on_incompatible(self, callback: IncompatibleHook) -> Callable[[], None]:
        """Call back with publisher, subscription and policies that do not fit."""
        self._on_incompatible.append(callback)
        return lambda: self._on_incompatible.remove(callback)

    def on_match(
        self, callback: Callable[[Endpoint, Endpoint, bool], None]
    ) -> Callable[[], None]:
        """Call back with publisher, subscription and whether they matched or left."""
        self._on_match.append(callback)
        return lambda: self._on_match.remove(callback)

    def on_liveliness(
        self, callback: Callable[[Endpoint, bool], None]
    ) -> Callable[[], None]:
        """Call back with a publisher and whether its lease holds or has lapsed."""
        self._on_liveliness.append(callback)
        return lambda: self._on_liveliness.remove(callback)

    # -- what transports and nodes report --------------------------------------

    def add_transport(self, transport: Transport) -> None:
        self.transports.append(transport)
        transport.observe(self)

    def close(self) -> None:
        """Close the transports."""
        for transport in self.transports:
            transport.close()

    def add_node(self, info: NodeInfo) -> None:
        self._nodes.append(info)
        self.graph_changed()

    def remove_node(self, info: NodeInfo) -> None:
        if info in self._nodes:
            self._nodes.remove(info)
            self.graph_changed()

    def new_gid(self) -> bytes:
        """A 16-byte id, the same ones in the same order in every run."""
        # next() is one step, also where several threads share the graph.
        return next(self._gids).to_bytes(16, "big")

    def graph_changed(self) -> None:
        for callback in tuple(self._on_change):
            callback()

    def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        for callback in tuple(self._on_match):
            callback(publisher, subscription, True)

    def unmatched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        for callback in tuple(self._on_match):
            callback(publisher, subscription, False)

    def report_liveliness(self, publisher: Endpoint, *, alive: bool) -> None:
        """A publisher's lease holds from now on, or has lapsed."""
        if alive:
            self.manually_alive.add(publisher.gid)
        else:
            self.manually_alive.discard(publisher.gid)
        for callback in tuple(self._on_liveliness):
            callback(publisher, alive)

    def incompatible_qos(
        self,
        publisher: Endpoint,
        subscription: Endpoint,
        policies: tuple[QoSPolicyKind, ...],
    ) -> None:
        for callback in tuple(self._on_incompatible):
            callback(publisher, subscription, policies)

    # -- queries ---------------------------------------------------------------

    def nodes(self) -> list[NodeInfo]:
        """In order of appearance; two nodes of one name are listed twice."""
        return list(self._nodes)

    def endpoints(
        self,
        topic: str | None = None,
        *,
        kind: EndpointKind | None = None,
        node: str | None = None,
    ) -> list[Endpoint]:
        """Endpoints by full topic name, kind, full node name; by topic, then age."""
        every = (e for t in self.transports for e in t.endpoints())
        return _selected(every, topic, kind, node)

    def service_endpoints(
        self,
        service: str | None = None,
        *,
        kind: EndpointKind | None = None,
        node: str | None = None,
    ) -> list[Endpoint]:
        """Servers and clients, chosen and sorted as :meth:`endpoints`."""
        every = (e for t in self.transports for e in t.service_endpoints())
        return _selected(every, service, kind, node)

    def topics(self) -> dict[str, list[str]]:
        """Full topic name → type names, sorted by name."""
        return names_and_types(self.endpoints())

    def services(self) -> dict[str, list[str]]:
        """Full name of each served service → type names, sorted by name."""
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


def names_and_types(endpoints: list[Endpoint]) -> dict[str, list[str]]:
    """Topic → sorted type names of the given endpoints."""
    found: dict[str, set[str]] = {}
    for endpoint in endpoints:
        found.setdefault(endpoint.topic, set()).add(endpoint.type_name)
    return {topic: sorted(found[topic]) for topic in sorted(found)}
