"""Which transports a context has: in process only, or the network beside it."""

import os
from collections.abc import Callable

from navette.errors import InvalidValueError
from navette.runtime.clock import ContextClock, PacedClock, VirtualClock
from navette.runtime.graph import Graph
from navette.runtime.lockstep import LockStepClock

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


def chosen_transport(asked: str | None, clock: ContextClock) -> str:
    """What is asked for, else ``NAVETTE_TRANSPORT``, else what suits the run.

    A lock-step run in virtual time stays alone, so that it is the same every time;
    tests under pytest stay alone, so that they do not meet each other.

    Raises:
        InvalidValueError: the variable names no transport, or one that cannot be.
    """
    if clock.is_shared:
        if (asked or os.environ.get(VARIABLE)) == IN_PROCESS:
            raise InvalidValueError(
                f"transport {IN_PROCESS!r}: a lock-step with other processes needs "
                f"{ZENOH!r}"
            )
        return ZENOH
    if asked is not None:
        return asked
    named = os.environ.get(VARIABLE)
    if named:
        return checked_transport(named, VARIABLE)
    lock_step = isinstance(clock, VirtualClock) and not isinstance(clock, PacedClock)
    if lock_step or "PYTEST_CURRENT_TEST" in os.environ:
        return IN_PROCESS
    return ZENOH


def join_network(
    graph: Graph,
    domain_id: int,
    now_ns: Callable[[], int],
    lock_step: LockStepClock | None = None,
) -> None:
    """Add the network to the graph's transports, unless it is one of them.

    Args:
        graph: what is joined to it.
        domain_id: separates systems on one network.
        now_ns: the time here.
        lock_step: the clock, where it is on one time with other processes.

    Raises:
        InvalidValueError: the graph has joined another domain, or has nodes already.
        NetworkError: the network cannot be joined.
    """
    with graph.joining:
        _join(graph, domain_id, now_ns, lock_step)


def _join(
    graph: Graph,
    domain_id: int,
    now_ns: Callable[[], int],
    lock_step: LockStepClock | None,
) -> None:
    # Imported here: who stays in process does not pay for it.
    from navette.transports.zenoh import ZenohTransport

    for transport in graph.transports:
        if isinstance(transport, ZenohTransport):
            if lock_step is not None:
                raise InvalidValueError(
                    "lock-step: only one context of a process can take part"
                )
            if transport.domain_id != domain_id:
                raise InvalidValueError(
                    f"domain {domain_id}: the programs of this process share the "
                    f"domain {transport.domain_id}"
                )
            return
    if graph.nodes():
        names = ", ".join(info.full_name for info in graph.nodes())
        raise InvalidValueError(f"cannot join the network: there are nodes ({names})")
    if lock_step is None:
        graph.add_transport(ZenohTransport(domain_id, now_ns))
        return
    from navette.transports.zenoh.lockstep import ZenohStepWire

    transport = ZenohTransport(domain_id, now_ns, traffic=lock_step.traffic)
    lock_step.join(ZenohStepWire(transport))
    graph.add_transport(transport)
