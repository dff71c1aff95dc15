"""Servers of services: a queue of requests and a callback that answers."""

from collections import deque
from collections.abc import Callable, Coroutine
from typing import Any

from navette.errors import MessageError
from navette.msgs import type_name
from navette.msgs.service_msgs.msg import ServiceEventInfo
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.events import Entity
from navette.runtime.loop import EventLoop
from navette.runtime.qos import QoSProfile
from navette.runtime.service_endpoint import ServiceEndpoint
from navette.runtime.service_introspection import ServiceEvents
from navette.transports import Endpoint, Request, RequestId, ServicePort


class Service(ServiceEndpoint, Entity):
    """Answers requests. Made by :meth:`Node.create_service`.

    Args:
        callback: ``callback(request, response)`` fills the response in and returns
            it; a coroutine may do so later.
        deferred: the callback is ``callback(request, request_id)`` instead and answers
            with :meth:`send_response` when it likes.
    """

    #: Also while a callback of its group waits for an answer.
    answers_calls = True

    __slots__ = (
        "_deferred",
        "_events",
        "_loop",
        "_on_destroy",
        "_queue",
        "callback",
        "endpoint",
        "ports",
        "qos_profile",
    )

    def __init__(
        self,
        endpoint: Endpoint,
        callback: Callable[[Any, Any], Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        loop: EventLoop,
        events: ServiceEvents,
        on_destroy: Callable[["Service"], None],
        *,
        deferred: bool = False,
    ) -> None:
        self.endpoint = endpoint
        self.callback = callback
        self.group = callback_group
        self.qos_profile = qos_profile
        self.ports: list[ServicePort] = []
        self._deferred = deferred
        self._loop = loop
        self._events = events
        # Without a bound: a request that is dropped is a client that waits for ever.
        self._queue: deque[Request] = deque()
        self._on_destroy = on_destroy

    def receive(self, request: Request) -> None:
        """Queue a request (the transport's sink)."""
        self._queue.append(request)
        self._loop.ready.append(self)
        if self._loop.waiting:
            self._loop.wake()

    def run(self) -> Any:
        """Answer the oldest request of the queue."""
        if not self._queue:  # destroyed while the event waited
            return None
        request = self._queue.popleft()
        self._events.report(
            ServiceEventInfo.REQUEST_RECEIVED, request.id, request=request.message
        )
        try:
            result = self._call(request)
            if not isinstance(result, Coroutine):
                self._answer(request.id, result)
                return None
        except Exception as error:
            self._fail(request.id, error)
            raise
        return self._answer_later(request.id, result)

    def send_response(self, response: Any, header: RequestId) -> None:
        """Answer the request with that id.

        Raises:
            MessageError: not of the service's response type (also a TypeError).
        """
        wanted = self.srv_type.Response
        if not isinstance(response, wanted):
            raise MessageError(
                f"service {self.srv_name}: the callback must return its "
                f"{type_name(wanted)}, got {response!r}"
            )
        for port in self.ports:
            port.reply(header, response)
        self._events.report(ServiceEventInfo.RESPONSE_SENT, header, response=response)

    def origin(self) -> tuple[str, str]:
        return self.endpoint.node_full_name, f"service {self.endpoint.topic}"

    def destroy(self) -> None:
        """Leave the service; what is queued is not answered any more."""
        for port in self.ports:
            port.close()
        self._queue.clear()
        self._on_destroy(self)

    def _call(self, request: Request) -> Any:
        if self._deferred:
            return self.callback(request.message, request.id)
        return self.callback(request.message, self.srv_type.Response())

    def _answer(self, request_id: RequestId, response: Any) -> None:
        if not self._deferred:
            self.send_response(response, request_id)

    async def _answer_later(
        self, request_id: RequestId, result: Coroutine[Any, Any, Any]
    ) -> None:
        try:
            self._answer(request_id, await result)
        except Exception as error:
            self._fail(request_id, error)
            raise

    def _fail(self, request_id: RequestId, error: Exception) -> None:
        """The exception goes its way here; the client must not wait for ever."""
        reason = f"{type(error).__name__}: {error}"
        for port in self.ports:
            port.fail(request_id, reason)
