"""Service servers: a queue of requests, and a callback that returns responses."""

from collections import deque
from collections.abc import Callable, Coroutine
from typing import Any

from navette.errors import MessageError
from navette.msgs import type_name
from navette.msgs.service_msgs.msg import ServiceEventInfo
from navette.runtime.callback_groups import CallbackGroup
from navette.runtime.events import Entity
from navette.runtime.node_entities import NodeEntities
from navette.runtime.qos import QoSProfile
from navette.runtime.service_endpoint import ServiceEndpoint
from navette.runtime.service_introspection import ServiceEvents
from navette.transports import Endpoint, Request, RequestId, ServicePort


class Service(ServiceEndpoint, Entity):
    """Responds to requests. Created by :meth:`Node.create_service`.

    Args:
        callback: ``callback(request, response)`` fills in and returns the response;
            may be a coroutine function.
        deferred: the callback is ``callback(request, request_id)`` and responds at any
            time with :meth:`send_response`.
    """

    #: Runs also while a callback of its group waits for a response.
    runs_during_calls = True

    __slots__ = (
        "_deferred",
        "_entities",
        "_events",
        "_loop",
        "_queue",
        "callback",
        "endpoint",
        "ports",
        "qos_profile",
        "srv_name",
    )

    def __init__(
        self,
        endpoint: Endpoint,
        callback: Callable[[Any, Any], Any],
        *,
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        events: ServiceEvents,
        entities: NodeEntities,
        srv_name: str,
        deferred: bool = False,
    ) -> None:
        self.endpoint = endpoint
        self.srv_name = srv_name
        self.callback = callback
        self.group = callback_group
        self.qos_profile = qos_profile
        self.ports: list[ServicePort] = []
        self._deferred = deferred
        self._loop = entities.context.loop
        self._events = events
        # Unbounded: the client of a dropped request would wait indefinitely.
        self._queue: deque[Request] = deque()
        self._entities = entities

    def receive(self, request: Request) -> None:
        """Queue a request (the transport's sink)."""
        self._queue.append(request)
        self._loop.ready.append(self)
        if self._loop.waiting:
            self._loop.wake()

    def run(self) -> Any:
        """Process the oldest queued request."""
        try:
            request = self._queue.popleft()
        except IndexError:  # destroyed while the event was queued
            return None
        self._events.report(
            ServiceEventInfo.REQUEST_RECEIVED, request.id, request=request.message
        )
        try:
            result = self._call(request)
            if not isinstance(result, Coroutine):
                self._respond(request.id, result)
                return None
        except Exception as error:  # a callback may raise anything; raised again
            self._fail(request.id, error)
            raise
        return self._respond_later(request.id, result)

    def send_response(self, response: Any, header: RequestId) -> None:
        """Send the response to the request with that id.

        Raises:
            MessageError: ``response`` is of another type (also a TypeError).
        """
        expected = self.srv_type.Response
        if not isinstance(response, expected):
            raise MessageError(
                f"service {self.service_name}: the callback must return its "
                f"{type_name(expected)}, got {response!r}"
            )
        for port in self.ports:
            port.reply(header, response)
        self._events.report(ServiceEventInfo.RESPONSE_SENT, header, response=response)

    def origin(self) -> tuple[str, str]:
        return self.endpoint.node_full_name, f"service {self.endpoint.topic}"

    def destroy(self) -> None:
        """Leave the service; queued requests get no response."""
        for port in self.ports:
            port.close()
        self._queue.clear()
        self._entities.forget(self)

    def _call(self, request: Request) -> Any:
        if self._deferred:
            return self.callback(request.message, request.id)
        return self.callback(request.message, self.srv_type.Response())

    def _respond(self, request_id: RequestId, response: Any) -> None:
        if not self._deferred:
            self.send_response(response, request_id)

    async def _respond_later(
        self, request_id: RequestId, result: Coroutine[Any, Any, Any]
    ) -> None:
        try:
            self._respond(request_id, await result)
        except Exception as error:  # a callback may raise anything; raised again
            self._fail(request_id, error)
            raise

    def _fail(self, request_id: RequestId, error: Exception) -> None:
        """Report the failure to the client, which would otherwise wait indefinitely."""
        reason = f"{type(error).__name__}: {error}"
        for port in self.ports:
            port.fail(request_id, reason)
