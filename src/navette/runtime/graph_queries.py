"""Graph queries of a node, with rclpy's names."""

from navette.runtime.exceptions import NodeNameNonExistentError
from navette.runtime.graph import Graph, names_and_types
from navette.runtime.loop import EventLoop
from navette.runtime.names import NodeRemapper, full_node_name, normalize_namespace
from navette.runtime.topic_endpoint_info import ServiceEndpointInfo, TopicEndpointInfo
from navette.transports import Endpoint, EndpointKind

NamesAndTypes = list[tuple[str, list[str]]]


class GraphQueries:
    """Base class of :class:`Node`: which nodes, topics and services exist."""

    def __init__(self, graph: Graph, loop: EventLoop, remapper: NodeRemapper) -> None:
        self._node_graph = graph
        self._node_loop = loop
        self._node_remapper = remapper

    def get_node_names(self) -> list[str]:
        return [info.name for info in self._node_graph.nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        return [info.full_name for info in self._node_graph.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return [(info.name, info.namespace) for info in self._node_graph.nodes()]

    def get_node_names_and_namespaces_with_enclaves(
        self,
    ) -> list[tuple[str, str, str]]:
        nodes = self._node_graph.nodes()
        return [(info.name, info.namespace, info.enclave) for info in nodes]

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        return list(self._node_graph.topics().items())

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        return self._node_by_node(EndpointKind.PUBLISHER, node_name, node_namespace)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        return self._node_by_node(EndpointKind.SUBSCRIPTION, node_name, node_namespace)

    def get_service_names_and_types(self) -> NamesAndTypes:
        return list(self._node_graph.services().items())

    def get_service_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        return self._node_by_node(EndpointKind.SERVICE, node_name, node_namespace)

    def get_client_names_and_types_by_node(
        self, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        return self._node_by_node(EndpointKind.CLIENT, node_name, node_namespace)

    def count_services(self, service_name: str) -> int:
        return len(self._node_on_service(EndpointKind.SERVICE, service_name))

    def count_clients(self, service_name: str) -> int:
        return len(self._node_on_service(EndpointKind.CLIENT, service_name))

    def count_publishers(self, topic_name: str) -> int:
        topic = self.resolve_topic_name(topic_name)
        return self._node_graph.count(topic, EndpointKind.PUBLISHER)

    def count_subscribers(self, topic_name: str) -> int:
        topic = self.resolve_topic_name(topic_name)
        return self._node_graph.count(topic, EndpointKind.SUBSCRIPTION)

    def get_publishers_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        found = self._node_on_topic(EndpointKind.PUBLISHER, topic_name)
        return [TopicEndpointInfo.of(endpoint) for endpoint in found]

    def get_subscriptions_info_by_topic(
        self, topic_name: str, no_mangle: bool = False
    ) -> list[TopicEndpointInfo]:
        found = self._node_on_topic(EndpointKind.SUBSCRIPTION, topic_name)
        return [TopicEndpointInfo.of(endpoint) for endpoint in found]

    def get_servers_info_by_service(
        self, service_name: str, no_mangle: bool = False
    ) -> list[ServiceEndpointInfo]:
        found = self._node_on_service(EndpointKind.SERVICE, service_name)
        return [ServiceEndpointInfo.of(endpoint) for endpoint in found]

    def get_clients_info_by_service(
        self, service_name: str, no_mangle: bool = False
    ) -> list[ServiceEndpointInfo]:
        found = self._node_on_service(EndpointKind.CLIENT, service_name)
        return [ServiceEndpointInfo.of(endpoint) for endpoint in found]

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Run events until the node exists; False after ``timeout`` seconds."""
        name = "/" + fully_qualified_node_name.lstrip("/")
        loop = self._node_loop
        loop.run(
            until_ns=loop.clock.now_ns + round(timeout * 1e9),
            done=lambda: name in self.get_fully_qualified_node_names(),
        )
        return name in self.get_fully_qualified_node_names()

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the full name after expansion and remapping."""
        return self._node_remapper.resolve(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the full name after expansion and remapping."""
        return self._node_remapper.resolve(
            service, is_service=True, only_expand=only_expand
        )

    def _node_on_topic(self, kind: EndpointKind, topic_name: str) -> list[Endpoint]:
        topic = self.resolve_topic_name(topic_name)
        return self._node_graph.endpoints(topic, kind=kind)

    def _node_on_service(self, kind: EndpointKind, service_name: str) -> list[Endpoint]:
        service = self.resolve_service_name(service_name)
        return self._node_graph.service_endpoints(service, kind=kind)

    def _node_by_node(
        self, kind: EndpointKind, node_name: str, node_namespace: str
    ) -> NamesAndTypes:
        full_name = full_node_name(node_name, normalize_namespace(node_namespace))
        known = self.get_fully_qualified_node_names()
        if full_name not in known:
            raise NodeNameNonExistentError.of("node", full_name, known)
        graph = self._node_graph
        if kind in (EndpointKind.SERVICE, EndpointKind.CLIENT):
            endpoints = graph.service_endpoints(kind=kind, node=full_name)
        else:
            endpoints = graph.endpoints(kind=kind, node=full_name)
        return list(names_and_types(endpoints).items())
