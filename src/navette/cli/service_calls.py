"""Asking running nodes by their services, all at once, and not for ever."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any, NamedTuple

from navette.cli.nearest import did_you_mean
from navette.cli.session import (
    endpoints,
    fail,
    is_hidden,
    service_endpoints,
    wait_for,
)
from navette.cli.stderr import note

if TYPE_CHECKING:
    from navette.runtime import Future, Node

ANSWER_S = 2.0
"""Who has not answered by then hangs, or is stopped."""

_patience_s = ContextVar("_patience_s", default=ANSWER_S)

GET_STATE = "lifecycle_msgs/srv/GetState"


class Question(NamedTuple):
    """A request: to which service, of which type, with which fields."""

    service: str
    type_name: str
    fields: dict[str, Any]


class Answer(NamedTuple):
    """A response, or why there is none."""

    response: Any
    reason: str = ""


@contextmanager
def patient(seconds: float) -> Iterator[None]:
    """Inside, answers are waited for so long."""
    before = _patience_s.set(seconds)
    try:
        yield
    finally:
        _patience_s.reset(before)


def patience_s() -> float:
    """How long an answer is waited for, in seconds."""
    return _patience_s.get()


def ask_all(
    node: "Node", questions: Sequence[Question], timeout_s: float | None = None
) -> list[Answer]:
    """Ask all of them at the same time; an answer each, in that order.

    A service that nobody serves is not waited for, the others for :func:`patience_s`
    if no time is given.
    """
    from navette.msgs import get_interface

    there = served(node)
    futures: list[Future[Any] | None] = []
    for question in questions:
        if question.service not in there:
            futures.append(None)
            continue
        client = node.create_client(get_interface(question.type_name), question.service)
        request = client.srv_type.Request(**question.fields)
        futures.append(client.call_async(request))
    limit_s = patience_s() if timeout_s is None else timeout_s
    wait_for(node, lambda: all(f is None or f.done() for f in futures), limit_s)
    return [
        answer(future, question.service)
        for future, question in zip(futures, questions, strict=True)
    ]


def served(node: "Node") -> set[str]:
    """Full names of the services that somebody serves."""
    from navette.transports import EndpointKind

    return {e.topic for e in service_endpoints(node, kind=EndpointKind.SERVICE)}


def answer(future: Any, service: str) -> Answer:
    """What a future of a response has come to; None: nobody was asked."""
    if future is None:
        return Answer(None, f"nobody serves {service}")
    if not future.done():
        return Answer(None, f"service {service}: no answer")
    if future.exception() is not None:
        return Answer(None, str(future.exception()))
    return Answer(future.result())


def ask(node: "Node", service: str, type_name: str, **fields: Any) -> Any:
    """Ask one; ends the command if there is no answer."""
    (got,) = ask_all(node, [Question(service, type_name, fields)])
    if got.response is None:
        fail(got.reason)
    return got.response


def node_names(node: "Node", *, hidden: bool = False) -> list[str]:
    """Full names of the nodes that run, this one aside; a name per node, sorted."""
    names = node.get_fully_qualified_node_names()
    names.remove(node.get_fully_qualified_name())
    return sorted(name for name in names if hidden or not is_hidden(name))


def note_none(node: "Node", what: str) -> None:
    """Say why a list is empty: nothing runs here, or none of that kind."""
    if node_names(node, hidden=True) or endpoints(node):
        note(f"no {what}")
    else:
        domain = node.context.get_domain_id()
        note(f"no {what}: nothing runs in domain {domain} (ROS_DOMAIN_ID)")


def managed_nodes(here: "Node", *, hidden: bool = False) -> list[str]:
    """Full names of the nodes that serve their state, sorted."""
    from navette.transports import EndpointKind

    serving = {
        end.topic.removesuffix("/get_state")
        for end in service_endpoints(here, kind=EndpointKind.SERVICE)
        if end.type_name == GET_STATE
    }
    return sorted(serving & set(node_names(here, hidden=hidden)))


def chosen_node(node: "Node", name: str, known: Sequence[str] | None = None) -> str:
    """The full name of a node that runs; ends the command where there is none.

    Args:
        name: as typed; a leading slash may be left out.
        known: those to choose from, where not all will do.
    """
    full = "/" + name.strip("/")
    every = node_names(node, hidden=True)
    if full in (every if known is None else known):
        return full
    if full in every:
        fail(f"node {full} is not one of those: {', '.join(known or ()) or 'none'}")
    if not every:
        fail(
            f"no node {full}: nothing runs here (or not with this ROS_DOMAIN_ID and"
            " NAVETTE_ROUTER)"
        )
    return fail(
        f"no node {full}{did_you_mean(full, every if known is None else known)}"
    )
