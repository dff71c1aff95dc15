"""Request the result of a goal, which may take hours."""

from typing import Any

from navette.runtime.client import Client
from navette.runtime.clock import ContextClock
from navette.runtime.exceptions import ServiceTimeoutError
from navette.runtime.future import Future, ResponseFuture

# A timeout reported earlier than this is a failure and not retried.
_MIN_TIMEOUT_NS = 50_000_000


class ResultRequest:
    """Repeats a request for a result after each timeout, while the server exists.

    The request has no side effects at the server, so it can be repeated. A transport
    that kept requests open for the duration of an action would need memory for all of
    them.

    Attributes:
        future: gets the response or the failure; cancelling it ends the requests.
    """

    def __init__(self, client: Client, request: Any, clock: ContextClock) -> None:
        self.future: Future[Any] = ResponseFuture()
        self._client = client
        self._request = request
        self._clock = clock
        self._pending: Future[Any] = Future()
        self._send()
        self.future.add_done_callback(lambda _: self._pending.cancel())

    def _send(self) -> None:
        self._sent_ns = self._clock.now_ns
        self._pending = self._client.call_async(self._request)
        self._pending.add_done_callback(self._take)

    def _take(self, pending: Future[Any]) -> None:
        error = pending.exception()
        if self.future.done():
            return
        if pending.cancelled():
            self.future.cancel()
        elif error is None:
            self.future.set_result(pending.result())
        elif isinstance(error, ServiceTimeoutError) and self._can_retry():
            self._send()
        else:
            self.future.set_exception(error)

    def _can_retry(self) -> bool:
        waited_ns = self._clock.now_ns - self._sent_ns
        return waited_ns >= _MIN_TIMEOUT_NS and self._client.service_is_ready()
