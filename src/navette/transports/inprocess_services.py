"""Services in memory: a request is copied to the server, the reply to the client."""

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
    """Names the sink that the clients of the service call."""

    __slots__ = ("_table", "endpoint", "sink")

    def __init__(
        self, endpoint: Endpoint, sink: RequestSink, table: "ServiceTable"
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
        if request_id.ticket:  # another transport's, in whosever name
            return None
        return self._table.clients_by_gid.get(request_id.client_gid)


class InProcessClient(ClientPort):
    """Calls the sinks of the servers that fit, oldest first."""

    __slots__ = ("_table", "endpoint", "servers", "sink")

    def __init__(
        self, endpoint: Endpoint, sink: ReplySink, table: "ServiceTable"
    ) -> None:
        self.endpoint = endpoint
        self.sink = sink
        self._table = table
        # Replaced as a whole on a change: a calling thread sees the old or the new.
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


class ServiceTable:
    """All servers and clients of a transport, by the name of their service.

    Args:
        lock: taken around every change.
        changed: called after every change.
    """

    def __init__(self, lock: threading.RLock, changed: Callable[[], None]) -> None:
        self.clients_by_gid: dict[bytes, InProcessClient] = {}
        self._ports: dict[str, list[Port]] = {}
        self._lock = lock
        self._changed = changed

    def serve(self, endpoint: Endpoint, sink: RequestSink) -> InProcessService:
        """Open a server's port."""
        service = InProcessService(endpoint, sink, self)
        self._add(service)
        return service

    def connect(self, endpoint: Endpoint, sink: ReplySink) -> InProcessClient:
        """Open a client's port."""
        client = InProcessClient(endpoint, sink, self)
        self._add(client)
        self.clients_by_gid[endpoint.gid] = client
        return client

    def remove(self, port: Port) -> None:
        """Take the port off its service."""
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
            self._changed()

    def ports(self) -> list[Port]:
        """All ports, by service in order of appearance."""
        with self._lock:
            return [port for ports in self._ports.values() for port in ports]

    def _add(self, port: Port) -> None:
        with self._lock:
            ports = self._ports.setdefault(port.endpoint.topic, [])
            _check_type(port.endpoint, ports)
            ports.append(port)
            _relink(ports)
            self._changed()


def _relink(ports: list[Port]) -> None:
    """Give every client the servers that fit it."""
    servers = [port for port in ports if isinstance(port, InProcessService)]
    for port in ports:
        if isinstance(port, InProcessClient):
            port.servers = tuple(s for s in servers if _fits(port, s))


def _fits(client: InProcessClient, service: InProcessService) -> bool:
    """Whether requests reach the server and replies the client."""
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
        f"service {endpoint.topic} is of type {ports[0].endpoint.type_name} "
        f"({', '.join(others)}); node {endpoint.node_full_name} wants to {verb} it "
        f"as {endpoint.type_name}"
    )
