"""Which transports a context has: in process only, or the network beside it."""

import os
from collections.abc import Callable

from navette.errors import InvalidValueError
from navette.runtime.clock import PacedClock, TimeSource, VirtualClock
from navette.runtime.graph import Graph

IN_PROCESS, ZENOH = "inprocess", "zenoh"
TRANSPORTS = (IN_PROCESS, ZENOH)
VARIABLE = "NAVETTE_TRANSPORT"


def checked_transport(name: str, source: str) -> str:
    """The name, if there is such a transport.

    Raises:
        InvalidValueError: lists those that there are.
    """
    if name not in TRANSPORTS:
        known = ", ".join(TRANSPORTS)
        raise InvalidValueError(f"{source}: transport {name!r}; known: {known}")
    return name


def chosen_transport(asked: str | None, clock: TimeSource) -> str:
    """What is asked for, else ``NAVETTE_TRANSPORT``, else what suits the run.

    A lock-step run in virtual time stays alone, so that it is the same every time;
    tests under pytest stay alone, so that they do not meet each other.

    Raises:
        InvalidValueError: the variable names no transport.
    """
    if asked is not None:
        return asked
    named = os.environ.get(VARIABLE)
    if named:
        return checked_transport(named, VARIABLE)
    lock_step = isinstance(clock, VirtualClock) and not isinstance(clock, PacedClock)
    if lock_step or "PYTEST_CURRENT_TEST" in os.environ:
        return IN_PROCESS
    return ZENOH


def join_network(graph: Graph, domain_id: int, now_ns: Callable[[], int]) -> None:
    """Add the network to the graph's transports, unless it is one of them.

    Raises:
        InvalidValueError: the graph has joined another domain, or has nodes already.
        NetworkError: the network cannot be joined.
    """
    with graph.joining:
        _join(graph, domain_id, now_ns)


def _join(graph: Graph, domain_id: int, now_ns: Callable[[], int]) -> None:
    # Imported here: who stays in process does not pay for it.
    from navette.transports.zenoh import ZenohTransport

    for transport in graph.transports:
        if isinstance(transport, ZenohTransport):
            if transport.domain_id != domain_id:
                raise InvalidValueError(
                    f"domain {domain_id}: the programs of this process share the "
                    f"domain {transport.domain_id}"
                )
            return
    if graph.nodes():
        names = ", ".join(info.full_name for info in graph.nodes())
        raise InvalidValueError(f"cannot join the network: there are nodes ({names})")
    graph.add_transport(ZenohTransport(domain_id, now_ns))
