"""Clients of services: requests out, replies into futures."""

import threading
from collections import deque
from collections.abc import Callable
from typing import Any

from navette.errors import MessageError
from navette.msgs import type_name
from navette.msgs.service_msgs.msg import ServiceEventInfo
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.context import Context
from navette.runtime.events import Entity
from navette.runtime.exceptions import (
    InvalidHandle,
    ROSInterruptException,
    ServiceFailedError,
    ServiceTimeoutError,
)
from navette.runtime.future import Answer, Future
from navette.runtime.qos import QoSProfile
from navette.runtime.service_endpoint import ServiceEndpoint
from navette.runtime.service_introspection import ServiceEvents
from navette.runtime.time import seconds_to_ns
from navette.transports import ClientPort, Endpoint, Reply, RequestId, Transport


class _Replies(Entity):
    """Hands queued replies to their futures, whatever the client's group does.

    A callback that waits for a reply holds its group: a reply that had to wait for
    the same group would never come.
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
    """Calls a service. Made by :meth:`Node.create_client`."""

    def __init__(
        self,
        context: Context,
        endpoint: Endpoint,
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        events: ServiceEvents,
        on_destroy: Callable[["Client"], None],
    ) -> None:
        self.context = context
        self.endpoint = endpoint
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
        self._on_destroy = on_destroy

    def open_port(self, transport: Transport) -> None:
        """Ask through that transport too.

        Raises:
            InvalidValueError: the service is of another type; both are named.
        """
        port = transport.connect(self.endpoint, self.receive)
        self.ports.append(port)
        self._sequence = max(self._sequence, port.initial_sequence)

    # -- calling ---------------------------------------------------------------

    def call_async(self, request: Any) -> Future[Any]:
        """Send a request; the future gets the response.

        Raises:
            MessageError: not of the service's request type (also a TypeError).
        """
        if self._destroyed:
            raise InvalidHandle(f"client of {self.srv_name} was destroyed")
        wanted = self.srv_type.Request
        if not isinstance(request, wanted):
            raise MessageError(
                f"service {self.srv_name}: expected {type_name(wanted)}, got "
                f"{type(request).__name__}"
            )
        future: Future[Any] = Answer()
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
        """Send a request and let events run until the response is there.

        Also from within a callback: its group is held meanwhile, except for servers,
        which answer.

        Raises:
            TimeoutError: no response in time (or, under a virtual clock, ever).
            ROSInterruptException: the context was shut down or the client destroyed.
            ServiceFailedError: the server's callback raised.
        """
        future = self.call_async(request)
        self._loop.run(
            until_ns=self._deadline_ns(timeout_sec), done=future.done, calling=True
        )
        if future.cancelled():  # the client was destroyed, most often by a shutdown
            raise ROSInterruptException
        if not future.done():
            self.remove_pending_request(future)
            servers = sum(port.server_count for port in self.ports)
            raise TimeoutError(
                f"service {self.srv_name}: no response "
                + (f"in {timeout_sec:g} s" if timeout_sec is not None else "")
                + ("" if servers else " (nobody serves it)")
            )
        return future.result()

    def get_pending_request(self, sequence_number: int) -> Future[Any]:
        """The future of a request under way; KeyError if there is none."""
        with self._lock:
            return self._pending[sequence_number]

    def remove_pending_request(self, future: Future[Any]) -> None:
        """Forget a request: its response will be ignored."""
        with self._lock:
            for sequence, pending in self._pending.items():
                if pending is future:
                    del self._pending[sequence]
                    return

    # -- the server ------------------------------------------------------------

    def service_is_ready(self) -> bool:
        """Whether somebody serves it."""
        return any(port.server_count for port in self.ports)

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Let events run until somebody serves it; False after the timeout."""
        if not self.service_is_ready():
            self._loop.run(
                until_ns=self._deadline_ns(timeout_sec), done=self.service_is_ready
            )
        return self.service_is_ready()

    # -- inside ----------------------------------------------------------------

    def receive(self, reply: Reply) -> None:
        """Queue a reply (the transport's sink)."""
        self._replies.queue.append(reply)
        self._loop.ready.append(self._replies)
        if self._loop.waiting:
            self._loop.wake()

    def take(self, reply: Reply) -> None:
        """Finish the future of a reply; the first reply counts."""
        with self._lock:
            future = self._pending.pop(reply.sequence, None)
        if future is None:
            return
        if reply.message is None:
            error = ServiceTimeoutError if reply.timed_out else ServiceFailedError
            future.set_exception(
                error(f"service {self.srv_name} failed: {reply.failure}")
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
        """Leave the service; what is under way is cancelled."""
        self._destroyed = True
        for port in self.ports:
            port.close()
        for future in list(self._pending.values()):
            future.cancel()
        self._on_destroy(self)

    def _deadline_ns(self, timeout_sec: float | None) -> int | None:
        if timeout_sec is None or timeout_sec < 0:
            return None
        return self._loop.clock.now_ns + seconds_to_ns(float(timeout_sec))
