"""In-process services: requests and replies are copied."""

import threading
from collections.abc import Callable
from typing import Any

from navette.errors import InvalidValueError
from navette.msgs import copy_message
from navette.transports.base import Endpoint, EndpointKind
from navette.transports.qos import incompatible_policies
from navette.transports.service_ports import (
    ClientPort,
    Reply,
    ReplySink,
    Request,
    RequestId,
    RequestSink,
    ServicePort,
)


class InProcessService(ServicePort):
    """Holds the sink that the clients of the service call."""

    def __init__(
        self, endpoint: Endpoint, table: "ServiceTable", *, sink: RequestSink
    ) -> None:
        self.endpoint = endpoint
        self.sink = sink
        self._table = table

    def reply(self, request_id: RequestId, message: Any) -> None:
        client = self._client_of(request_id)
        if client is not None:
            client.sink(Reply(copy_message(message), request_id.sequence))

    def fail(self, request_id: RequestId, reason: str) -> None:
        client = self._client_of(request_id)
        if client is not None:
            client.sink(Reply(None, request_id.sequence, reason))

    def close(self) -> None:
        self._table.remove(self)

    def _client_of(self, request_id: RequestId) -> "InProcessClient | None":
        if request_id.ticket:  # of another transport, whatever gid it has
            return None
        return self._table.clients_by_gid.get(request_id.client_gid)


class InProcessClient(ClientPort):
    """Calls the sinks of the compatible servers, oldest first."""

    def __init__(
        self, endpoint: Endpoint, table: "ServiceTable", *, sink: ReplySink
    ) -> None:
        self.endpoint = endpoint
        self.sink = sink
        self._table = table
        # Replaced as a whole, so that a calling thread sees no partial change.
        self.servers: tuple[InProcessService, ...] = ()

    def request(self, message: Any, source_ns: int, sequence: int) -> None:
        request_id = RequestId(self.endpoint.gid, sequence)
        for server in self.servers:
            server.sink(
                Request(copy_message(message), source_ns, source_ns, request_id)
            )

    @property
    def server_count(self) -> int:
        return len(self.servers)

    def close(self) -> None:
        self._table.remove(self)


Port = InProcessService | InProcessClient

OnServicesChanged = Callable[[], None]
"""Called under the lock after a server or client was added or removed."""


class ServiceTable:
    """All servers and clients of a transport, by service name.

    Args:
        lock: held during every change.
    """

    def __init__(self, lock: threading.RLock, *, on_change: OnServicesChanged) -> None:
        self.clients_by_gid: dict[bytes, InProcessClient] = {}
        self._ports: dict[str, list[Port]] = {}
        self._lock = lock
        self._on_change = on_change

    def serve(self, endpoint: Endpoint, sink: RequestSink) -> InProcessService:
        service = InProcessService(endpoint, self, sink=sink)
        self._add(service)
        return service

    def connect(self, endpoint: Endpoint, sink: ReplySink) -> InProcessClient:
        client = InProcessClient(endpoint, self, sink=sink)
        self._add(client)
        self.clients_by_gid[endpoint.gid] = client
        return client

    def remove(self, port: Port) -> None:
        name = port.endpoint.topic
        with self._lock:
            ports = self._ports.get(name, [])
            if port not in ports:
                return
            ports.remove(port)
            self.clients_by_gid.pop(port.endpoint.gid, None)
            if not ports:
                del self._ports[name]
            _relink(ports)
            self._on_change()

    def ports(self) -> list[Port]:
        with self._lock:
            return [port for ports in self._ports.values() for port in ports]

    def _add(self, port: Port) -> None:
        with self._lock:
            ports = self._ports.setdefault(port.endpoint.topic, [])
            _check_type(port.endpoint, ports)
            ports.append(port)
            _relink(ports)
            self._on_change()


def _relink(ports: list[Port]) -> None:
    """Assign the compatible servers to every client."""
    servers = [port for port in ports if isinstance(port, InProcessService)]
    for port in ports:
        if isinstance(port, InProcessClient):
            port.servers = tuple(s for s in servers if _is_compatible(port, s))


def _is_compatible(client: InProcessClient, service: InProcessService) -> bool:
    """Return whether the QoS allows requests and replies."""
    mine, other = client.endpoint.qos, service.endpoint.qos
    return not (
        incompatible_policies(mine, other) or incompatible_policies(other, mine)
    )


def _check_type(endpoint: Endpoint, ports: list[Port]) -> None:
    if not ports or ports[0].endpoint.type_name == endpoint.type_name:
        return
    others = sorted({port.endpoint.node_full_name for port in ports})
    verb = "serve" if endpoint.kind is EndpointKind.SERVICE else "call"
    raise InvalidValueError(
        f"service {endpoint.topic} has the type {ports[0].endpoint.type_name} "
        f"({', '.join(others)}); node {endpoint.node_full_name} cannot {verb} it "
        f"as {endpoint.type_name}"
    )
