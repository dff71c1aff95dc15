"""Service clients: send requests and complete futures with the replies."""

import threading
from collections import deque
from typing import Any

from navette.msgs.service_msgs.msg import ServiceEventInfo
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.callback_threads import group_of_this_thread
from navette.runtime.events import Entity
from navette.runtime.exceptions import (
    InvalidHandle,
    ROSInterruptException,
    ServiceFailedError,
    ServiceTimeoutError,
)
from navette.runtime.future import Future, ResponseFuture
from navette.runtime.node_entities import NodeEntities
from navette.runtime.qos import QoSProfile
from navette.runtime.service_endpoint import ServiceEndpoint
from navette.runtime.service_introspection import ServiceEvents
from navette.runtime.strict_mode import check_wait
from navette.runtime.type_support import check_type
from navette.transports import ClientPort, Endpoint, Reply, RequestId, Transport


class _Replies(Entity):
    """Completes futures with queued replies, outside the client's callback group.

    A callback that waits for a reply holds its group; a reply that waited for the same
    group would never be processed.
    """

    __slots__ = ("_client", "queue")

    def __init__(self, client: "Client", group: CallbackGroup) -> None:
        self._client = client
        self.group = group
        self.queue: deque[Reply] = deque()

    def run(self) -> None:
        if self.queue:
            self._client.take(self.queue.popleft())

    def origin(self) -> tuple[str, str]:
        endpoint = self._client.endpoint
        return endpoint.node_full_name, f"reply of service {endpoint.topic}"


class Client(ServiceEndpoint):
    """Calls a service. Created by :meth:`Node.create_client`."""

    def __init__(
        self,
        endpoint: Endpoint,
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        events: ServiceEvents,
        entities: NodeEntities,
        *,
        srv_name: str,
    ) -> None:
        self.context = context = entities.context
        self.endpoint = endpoint
        self.srv_name = srv_name
        self.group = callback_group
        self.qos_profile = qos_profile
        self.ports: list[ClientPort] = []
        self._events = events
        self._loop = context.loop
        self._replies = _Replies(self, context.loop.free_group)
        self._pending: dict[int, Future[Any]] = {}
        self._sequence = 0
        self._lock = threading.Lock()
        self._destroyed = False
        self._entities = entities

    def open_port(self, transport: Transport) -> None:
        """Also send requests through that transport.

        Raises:
            InvalidValueError: the service has another type; names both.
        """
        port = transport.connect(self.endpoint, self.receive)
        self.ports.append(port)
        self._sequence = max(self._sequence, port.initial_sequence)

    def call_async(self, request: Any) -> Future[Any]:
        """Send a request; the future gets the response.

        Raises:
            MessageError: ``request`` is of another type (also a TypeError).
            InvalidHandle: the client was destroyed.
        """
        if self._destroyed:
            raise InvalidHandle(f"client of {self.service_name} was destroyed")
        check_type(request, self.srv_type.Request, f"service {self.service_name}")
        future: Future[Any] = ResponseFuture()
        with self._lock:
            self._sequence = sequence = self._sequence + 1
            self._pending[sequence] = future
        future.add_done_callback(self.remove_pending_request)
        self._events.report(
            ServiceEventInfo.REQUEST_SENT,
            RequestId(self.endpoint.gid, sequence),
            request=request,
        )
        for port in self.ports:
            port.request(request, self._loop.clock.now_ns, sequence)
        return future

    def call(self, request: Any, timeout_sec: float | None = None) -> Any:
        """Send a request and run events until the response arrives.

        May be called in a callback, whose group is held meanwhile except for servers.

        Raises:
            TimeoutError: no response within ``timeout_sec``, or no event left that
                could produce one (virtual clock).
            ROSInterruptException: the context was shut down or the client destroyed.
            ServiceFailedError: the server's callback raised.
        """
        waiting = group_of_this_thread()
        check_wait(
            f"call() of {self.service_name}",
            in_driver_thread=self._loop.in_driver_thread,
            same_group=waiting is self.group,
            exclusive=self.group.exclusive,
        )
        future = self.call_async(request)
        self._loop.run(
            until_ns=self._loop.deadline_ns(timeout_sec), done=future.done, calling=True
        )
        if future.cancelled():  # the client was destroyed, usually by a shutdown
            raise ROSInterruptException
        if not future.done():
            self.remove_pending_request(future)
            servers = sum(port.server_count for port in self.ports)
            raise TimeoutError(
                f"service {self.service_name}: no response "
                + (f"in {timeout_sec:g} s" if timeout_sec is not None else "")
                + ("" if servers else " (the service has no server)")
            )
        return future.result()

    def get_pending_request(self, sequence_number: int) -> Future[Any]:
        """Return the future of a pending request; KeyError if there is none."""
        with self._lock:
            return self._pending[sequence_number]

    def remove_pending_request(self, future: Future[Any]) -> None:
        """Remove a pending request; its response will be ignored."""
        with self._lock:
            for sequence, pending in self._pending.items():
                if pending is future:
                    del self._pending[sequence]
                    return

    def service_is_ready(self) -> bool:
        """Return whether the service has a server."""
        return any(port.server_count for port in self.ports)

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Run events until the service has a server; False after the timeout."""
        if not self.service_is_ready():
            self._loop.run(
                until_ns=self._loop.deadline_ns(timeout_sec), done=self.service_is_ready
            )
        return self.service_is_ready()

    def receive(self, reply: Reply) -> None:
        """Queue a reply (the transport's sink)."""
        self._replies.queue.append(reply)
        self._loop.ready.append(self._replies)
        if self._loop.waiting:
            self._loop.wake()

    def take(self, reply: Reply) -> None:
        """Complete the future of a reply; only the first reply counts."""
        with self._lock:
            future = self._pending.pop(reply.sequence, None)
        if future is None:
            return
        if reply.message is None:
            error = ServiceTimeoutError if reply.timed_out else ServiceFailedError
            future.set_exception(
                error(f"service {self.service_name} failed: {reply.failure}")
            )
        else:
            self._events.report(
                ServiceEventInfo.RESPONSE_RECEIVED,
                RequestId(self.endpoint.gid, reply.sequence),
                response=reply.message,
            )
            future.set_result(reply.message)
        self._loop.notify_threads()

    def destroy(self) -> None:
        """Leave the service and cancel pending requests."""
        self._destroyed = True
        for port in self.ports:
            port.close()
        for future in list(self._pending.values()):
            future.cancel()
        self._entities.forget(self)
