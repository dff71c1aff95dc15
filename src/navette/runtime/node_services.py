"""The service half of :class:`Node`, as rclpy has it: servers and clients."""

from collections.abc import Callable, Iterator
from typing import Any

from navette.errors import NavetteError
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.client import Client
from navette.runtime.context import Context
from navette.runtime.names import NodeRemapper
from navette.runtime.publisher import Publisher
from navette.runtime.qos import QoSProfile, qos_profile_services_default
from navette.runtime.service import Service
from navette.runtime.service_introspection import ServiceEvents
from navette.runtime.type_support import interface_name
from navette.transports import Endpoint, EndpointKind


class NodeServices:
    """Serve and call. Mixed into :class:`Node`."""

    _context: Context
    _remapper: NodeRemapper
    _entities: list[Any]

    def _check_alive(self) -> None:
        raise NotImplementedError

    def create_publisher(
        self, msg_type: Any, topic: str, qos_profile: QoSProfile | int
    ) -> Publisher[Any]:
        raise NotImplementedError

    def _own_group(self, group: CallbackGroup | None) -> CallbackGroup:
        raise NotImplementedError

    def _forget(self, entity: Any) -> None:
        raise NotImplementedError

    def _destroy(self, entity: Any) -> bool:
        raise NotImplementedError

    @property
    def services(self) -> Iterator[Service]:
        return (e for e in self._entities if isinstance(e, Service))

    @property
    def clients(self) -> Iterator[Client]:
        return (e for e in self._entities if isinstance(e, Client))

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Answer requests with ``callback(request, response) -> response``.

        The callback may be a coroutine function.
        """
        return self.serve(
            interface_name(srv_type, "srv"),
            srv_name,
            callback,
            qos_profile=qos_profile,
            callback_group=callback_group,
        )

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
        """As :meth:`create_service`, by type name (whose classes are made when used).

        Args:
            deferred: call back with (request, request id); the callback answers by
                :meth:`Service.send_response` when it likes.
        """
        if not callable(callback):
            raise TypeError(f"service {srv_name}: callback {callback!r} not callable")
        kind = EndpointKind.SERVICE
        endpoint = self._service_endpoint(kind, type_name, srv_name, qos_profile)
        service = Service(
            endpoint,
            callback,
            self._own_group(callback_group),
            qos_profile,
            self._context.loop,
            ServiceEvents(endpoint, self.create_publisher),
            self._forget,
            deferred=deferred,
        )
        self._entities.append(service)
        service.group.add_entity(service)
        try:
            for transport in self._context.graph.transports:
                service.ports.append(transport.serve(service.endpoint, service.receive))
        except NavetteError:
            service.destroy()
            raise
        if self._context.loop.is_driven_elsewhere:
            self._context.loop.wake()  # somebody may wait for it
        return service

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """A client of the service ``srv_name``."""
        kind = EndpointKind.CLIENT
        name = interface_name(srv_type, "srv")
        endpoint = self._service_endpoint(kind, name, srv_name, qos_profile)
        client = Client(
            self._context,
            endpoint,
            self._own_group(callback_group),
            qos_profile,
            ServiceEvents(endpoint, self.create_publisher),
            self._forget,
        )
        self._entities.append(client)
        client.group.add_entity(client)
        try:
            for transport in self._context.graph.transports:
                client.open_port(transport)
        except NavetteError:
            client.destroy()
            raise
        return client

    def destroy_service(self, service: Service) -> bool:
        return self._destroy(service)

    def destroy_client(self, client: Client) -> bool:
        return self._destroy(client)

    def _service_endpoint(
        self, kind: EndpointKind, type_name: str, name: str, qos: QoSProfile
    ) -> Endpoint:
        self._check_alive()
        if not isinstance(qos, QoSProfile):
            raise TypeError(f"service {name}: qos_profile {qos!r}: wanted a QoSProfile")
        endpoint = Endpoint(
            kind=kind,
            topic=self._remapper.resolve(name, is_service=True),
            type_name=type_name,
            qos=qos.to_endpoint_qos(),
            node_name=self._remapper.node_name,
            node_namespace=self._remapper.namespace,
            gid=b"",
        )
        return self._context.graph.with_gid(endpoint)
