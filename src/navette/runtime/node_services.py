"""Create a node's service servers and clients."""

from collections.abc import Callable
from typing import Any

from navette.errors import NavetteError
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.client import Client
from navette.runtime.node_entities import NodeEntities
from navette.runtime.node_topics import NodeTopics
from navette.runtime.qos import QoSProfile, qos_profile_services_default
from navette.runtime.service import Service
from navette.runtime.service_introspection import ServiceEvents
from navette.transports import Endpoint, EndpointKind


class NodeServices:
    """Factory of servers and clients; arguments as in :class:`Node`.

    Args:
        topics: creates the publishers for service introspection.
    """

    def __init__(self, entities: NodeEntities, topics: NodeTopics) -> None:
        self._entities = entities
        self._topics = topics

    def serve(
        self,
        type_name: str,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
        deferred: bool = False,
    ) -> Service:
        if not callable(callback):
            raise TypeError(f"service {srv_name}: callback {callback!r} not callable")
        endpoint = self._endpoint(
            EndpointKind.SERVICE, type_name, srv_name, qos_profile
        )
        context = self._entities.context
        service = Service(
            endpoint,
            callback,
            callback_group=self._entities.adopt(callback_group),
            qos_profile=qos_profile,
            events=ServiceEvents(endpoint, self._topics),
            entities=self._entities,
            srv_name=srv_name,
            deferred=deferred,
        )
        self._entities.add(service)
        try:
            for transport in context.graph.transports:
                service.ports.append(transport.serve(service.endpoint, service.receive))
        except NavetteError:
            service.destroy()
            raise
        if context.loop.is_driven_elsewhere:
            context.loop.wake()  # a wait_for_service may be running in that thread
        return service

    def create_client(
        self,
        type_name: str,
        srv_name: str,
        *,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup | None,
    ) -> Client:
        endpoint = self._endpoint(EndpointKind.CLIENT, type_name, srv_name, qos_profile)
        context = self._entities.context
        client = Client(
            endpoint,
            callback_group=self._entities.adopt(callback_group),
            qos_profile=qos_profile,
            events=ServiceEvents(endpoint, self._topics),
            entities=self._entities,
            srv_name=srv_name,
        )
        self._entities.add(client)
        try:
            for transport in context.graph.transports:
                client.open_port(transport)
        except NavetteError:
            client.destroy()
            raise
        return client

    def _endpoint(
        self, kind: EndpointKind, type_name: str, name: str, qos: QoSProfile
    ) -> Endpoint:
        if not isinstance(qos, QoSProfile):
            raise TypeError(
                f"service {name}: qos_profile must be a QoSProfile, got {qos!r}"
            )
        return self._entities.new_endpoint(kind, type_name, name, qos)
