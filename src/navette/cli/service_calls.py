"""Calls to services of running nodes: concurrent, with a timeout."""

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

RESPONSE_TIMEOUT_S = 2.0

_timeout_s = ContextVar("_timeout_s", default=RESPONSE_TIMEOUT_S)

GET_STATE = "lifecycle_msgs/srv/GetState"


class ServiceRequest(NamedTuple):
    """A request to a service."""

    service: str
    type_name: str
    fields: dict[str, Any]


class ServiceResponse(NamedTuple):
    """A response, or the reason for its absence."""

    response: Any
    reason: str = ""


@contextmanager
def response_timeout(seconds: float) -> Iterator[None]:
    """Set the default timeout inside the block."""
    before = _timeout_s.set(seconds)
    try:
        yield
    finally:
        _timeout_s.reset(before)


def response_timeout_s() -> float:
    """Return the default timeout in seconds."""
    return _timeout_s.get()


def call_all(
    node: "Node", requests: Sequence[ServiceRequest], timeout_s: float | None = None
) -> list[ServiceResponse]:
    """Send all requests concurrently; return a response for each, in order.

    Services without a server are not waited for. The default timeout is
    :func:`response_timeout_s`.
    """
    from navette.msgs import get_interface

    there = served(node)
    futures: list[Future[Any] | None] = []
    for each in requests:
        if each.service not in there:
            futures.append(None)
            continue
        client = node.create_client(get_interface(each.type_name), each.service)
        request = client.srv_type.Request(**each.fields)
        futures.append(client.call_async(request))
    limit_s = response_timeout_s() if timeout_s is None else timeout_s
    wait_for(node, lambda: all(f is None or f.done() for f in futures), limit_s)
    return [
        response_of(future, each.service)
        for future, each in zip(futures, requests, strict=True)
    ]


def served(node: "Node") -> set[str]:
    """Return the full names of services that have a server."""
    from navette.transports import EndpointKind

    return {e.topic for e in service_endpoints(node, kind=EndpointKind.SERVICE)}


def response_of(future: Any, service: str) -> ServiceResponse:
    """Return the result of a future; None stands for a service without server."""
    if future is None:
        return ServiceResponse(None, f"no server of {service}")
    if not future.done():
        return ServiceResponse(None, f"service {service}: no response")
    if future.exception() is not None:
        return ServiceResponse(None, str(future.exception()))
    return ServiceResponse(future.result())


def call(node: "Node", service: str, type_name: str, **fields: Any) -> Any:
    """Call one service; the command fails if there is no response."""
    (got,) = call_all(node, [ServiceRequest(service, type_name, fields)])
    if got.response is None:
        fail(got.reason)
    return got.response


def node_names(node: "Node", *, hidden: bool = False) -> list[str]:
    """Return the full names of all other nodes, sorted; duplicate names are kept."""
    names = node.get_fully_qualified_node_names()
    names.remove(node.get_fully_qualified_name())
    return sorted(name for name in names if hidden or not is_hidden(name))


def note_none(node: "Node", what: str) -> None:
    """Explain an empty list: no such thing, or no nodes at all in this domain."""
    if node_names(node, hidden=True) or endpoints(node):
        note(f"no {what}")
    else:
        domain = node.context.get_domain_id()
        note(f"no {what}: no nodes run in domain {domain} (ROS_DOMAIN_ID)")


def managed_nodes(here: "Node", *, hidden: bool = False) -> list[str]:
    """Return the full names of nodes with a lifecycle, sorted."""
    from navette.transports import EndpointKind

    serving = {
        end.topic.removesuffix("/get_state")
        for end in service_endpoints(here, kind=EndpointKind.SERVICE)
        if end.type_name == GET_STATE
    }
    return sorted(serving & set(node_names(here, hidden=hidden)))


def chosen_node(node: "Node", name: str, known: Sequence[str] | None = None) -> str:
    """Return the full name of a running node; the command fails if there is none.

    Args:
        name: with or without a leading slash.
        known: the allowed nodes; None allows all.
    """
    full = "/" + name.strip("/")
    every = node_names(node, hidden=True)
    if full in (every if known is None else known):
        return full
    if full in every:
        fail(f"node {full} is not one of {', '.join(known or ()) or 'none'}")
    if not every:
        fail(f"no node {full}: no nodes run with this ROS_DOMAIN_ID and NAVETTE_ROUTER")
    return fail(
        f"no node {full}{did_you_mean(full, every if known is None else known)}"
    )
