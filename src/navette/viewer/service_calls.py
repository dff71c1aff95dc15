"""Asynchronous calls to the services of other nodes, each with a timeout.

No method blocks: a call ends with a response, or with the reason why none came in time.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from navette.errors import NavetteError
from navette.msgs import Message, get_interface
from navette.viewer.graph_access import GraphAccess, ServiceClient
from navette.viewer.wall_clock import WallClock

TIMEOUT_S = 1.0

OnResponse = Callable[[Any, str], None]
"""Called with the response and "", or with None and the reason of the failure."""


@dataclass(eq=False, kw_only=True)
class _PendingCall:
    service: str
    future: Any
    timeout_s: float
    deadline_s: float
    on_response: OnResponse


class ServiceCalls:
    """Pending calls and the clients that they use; belongs to the executor's thread.

    Args:
        graph: creates the clients.
        clock: wall time; a frozen peer is frozen in real time.
    """

    def __init__(self, *, graph: GraphAccess, clock: WallClock) -> None:
        self._graph = graph
        self._clock = clock
        self._clients: dict[str, ServiceClient] = {}
        self._retained: set[str] = set()
        self._pending: list[_PendingCall] = []

    @property
    def pending(self) -> int:
        return len(self._pending)

    def call(
        self,
        service: str,
        type_name: str,
        request: Message | dict[str, Any],
        on_response: OnResponse,
        *,
        timeout_s: float = TIMEOUT_S,
    ) -> None:
        """Call a service; ``on_response`` is called exactly once, possibly at once.

        Args:
            request: the message or its fields.
        """
        try:
            client = self._clients.get(service)
            if client is None:
                interface = get_interface(type_name)
                client = self._graph.create_client(interface, service)
                self._clients[service] = client
            if isinstance(request, dict):
                request = client.srv_type.Request(**request)
            future = client.call_async(request)
        except NavetteError as error:
            self._destroy_unused(service)
            on_response(None, str(error))
            return
        call = _PendingCall(
            service=service,
            future=future,
            timeout_s=timeout_s,
            deadline_s=self._clock.now_s + timeout_s,
            on_response=on_response,
        )
        self._pending.append(call)
        future.add_done_callback(partial(self._on_done, call))

    def expire(self) -> None:
        """End the calls whose timeout has passed; call this a few times a second."""
        now_s = self._clock.now_s
        for call in [each for each in self._pending if each.deadline_s < now_s]:
            client = self._clients.get(call.service)
            if client is not None:
                client.remove_pending_request(call.future)
            self._finish(call, None, f"no response in {call.timeout_s:g} s")

    def retain(self, service: str) -> None:
        self._retained.add(service)

    def release(self, service: str) -> None:
        """Destroy the client of a service once no call needs it."""
        self._retained.discard(service)
        self._destroy_unused(service)

    def _on_done(self, call: _PendingCall, future: Any) -> None:
        if call not in self._pending:
            return
        if future.cancelled():
            self._finish(call, None, "the call was cancelled")
        elif future.exception() is not None:
            self._finish(call, None, str(future.exception()))
        else:
            self._finish(call, future.result(), "")

    def _finish(self, call: _PendingCall, response: Any, reason: str) -> None:
        self._pending.remove(call)
        self._destroy_unused(call.service)
        call.on_response(response, reason)

    def _destroy_unused(self, service: str) -> None:
        needed = service in self._retained or any(
            call.service == service for call in self._pending
        )
        if not needed and (client := self._clients.pop(service, None)) is not None:
            client.destroy()
