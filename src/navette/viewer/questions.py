"""Questions to the services of other nodes: many at once, none for ever.

Nobody waits for an answer: it is told when it comes, or that none came in time. A
program that is stopped or cut off costs its askers nothing but that.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

from navette.errors import NavetteError

ANSWER_S = 1.0

Answered = Callable[[Any, str], None]
"""Takes the response, or None and why there is none."""


class ServiceClient(Protocol):
    """What is needed of a client of a service."""

    @property
    def srv_type(self) -> Any: ...
    def call_async(self, request: Any) -> Any: ...
    def remove_pending_request(self, future: Any) -> None: ...
    def destroy(self) -> None: ...


@dataclass(eq=False)
class _Question:
    service: str
    future: Any
    patience_s: float
    deadline_s: float
    answered: Answered


class Questions:
    """Asks, hears, gives up. All methods belong to the executor's thread.

    Args:
        connect: makes a client of a service: name, type name.
        now_s: wall time that only grows; a frozen peer is frozen in real time.
    """

    def __init__(
        self, connect: Callable[[str, str], ServiceClient], now_s: Callable[[], float]
    ) -> None:
        self._connect = connect
        self._now_s = now_s
        self._clients: dict[str, ServiceClient] = {}
        self._kept: set[str] = set()
        self._under_way: list[_Question] = []

    @property
    def under_way(self) -> int:
        """Questions without an answer so far."""
        return len(self._under_way)

    def ask(
        self,
        service: str,
        type_name: str,
        fields: dict[str, Any],
        answered: Answered,
        *,
        patience_s: float = ANSWER_S,
    ) -> None:
        """Call a service; ``answered`` is called once, later or at once."""
        try:
            client = self._clients.get(service)
            if client is None:
                client = self._clients[service] = self._connect(service, type_name)
            future = client.call_async(client.srv_type.Request(**fields))
        except NavetteError as error:
            self._release(service)
            answered(None, str(error))
            return
        deadline_s = self._now_s() + patience_s
        question = _Question(service, future, patience_s, deadline_s, answered)
        self._under_way.append(question)
        future.add_done_callback(partial(self._on_done, question))

    def give_up_old(self) -> None:
        """Tell those who wait too long; to be called a few times a second."""
        now_s = self._now_s()
        for question in [q for q in self._under_way if q.deadline_s < now_s]:
            client = self._clients.get(question.service)
            if client is not None:
                client.remove_pending_request(question.future)
            self._finish(question, None, f"no answer in {question.patience_s:g} s")

    def keep(self, service: str) -> None:
        """Keep the client for more questions: it will be asked often."""
        self._kept.add(service)

    def let_go(self, service: str) -> None:
        """No more questions will come."""
        self._kept.discard(service)
        self._release(service)

    def _on_done(self, question: _Question, future: Any) -> None:
        if question not in self._under_way:
            return
        if future.cancelled():
            self._finish(question, None, "the call was cancelled")
        elif future.exception() is not None:
            self._finish(question, None, str(future.exception()))
        else:
            self._finish(question, future.result(), "")

    def _finish(self, question: _Question, response: Any, reason: str) -> None:
        self._under_way.remove(question)
        self._release(question.service)
        question.answered(response, reason)

    def _release(self, service: str) -> None:
        """Destroy the client unless somebody still needs it."""
        needed = service in self._kept or any(
            question.service == service for question in self._under_way
        )
        if not needed and (client := self._clients.pop(service, None)) is not None:
            client.destroy()
