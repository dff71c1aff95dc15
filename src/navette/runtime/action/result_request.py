"""Asking for a goal's result, which may take hours."""

from typing import Any

from navette.runtime.client import Client
from navette.runtime.clock import ContextClock
from navette.runtime.exceptions import ServiceTimeoutError
from navette.runtime.future import Answer, Future

# No answer to one request is waited for as little: who says so is not to be believed.
_SOONEST_NS = 50_000_000


class ResultRequest:
    """Asks again when the time of one request is over, while there is a server.

    To ask for a result changes nothing at the server, so it may be done twice; a
    request that stays open for as long as an action takes would cost memory for as
    long as the longest of them could take.

    Attributes:
        future: gets the response, or why there is none; to cancel it is to ask no more.
    """

    def __init__(self, client: Client, request: Any, clock: ContextClock) -> None:
        self.future: Future[Any] = Answer()
        self._client = client
        self._request = request
        self._clock = clock
        self._asked: Future[Any] = Future()
        self._ask()
        self.future.add_done_callback(lambda _: self._asked.cancel())

    def _ask(self) -> None:
        self._asked_ns = self._clock.now_ns
        self._asked = self._client.call_async(self._request)
        self._asked.add_done_callback(self._take)

    def _take(self, asked: Future[Any]) -> None:
        error = asked.exception()
        if self.future.done():
            return
        if asked.cancelled():
            self.future.cancel()
        elif error is None:
            self.future.set_result(asked.result())
        elif isinstance(error, ServiceTimeoutError) and self._may_ask_again():
            self._ask()
        else:
            self.future.set_exception(error)

    def _may_ask_again(self) -> bool:
        waited_ns = self._clock.now_ns - self._asked_ns
        return waited_ns >= _SOONEST_NS and self._client.service_is_ready()
