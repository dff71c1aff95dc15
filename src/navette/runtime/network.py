"""Choice of a context's transports: in process only, or also the network."""

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
    """Return the name of a transport.

    Raises:
        InvalidValueError: there is no such transport; lists the existing ones.
    """
    if name not in TRANSPORTS:
        known = ", ".join(TRANSPORTS)
        raise InvalidValueError(f"{source}: transport {name!r}; known: {known}")
    return name


def chosen_transport(requested: str | None, clock: ContextClock) -> str:
    """Return the requested transport, or ``NAVETTE_TRANSPORT``, or the default.

    The default is in process for a run in virtual time, which is then reproducible, and
    for tests under pytest, which are then isolated from each other; else Zenoh.

    Raises:
        InvalidValueError: the variable's transport does not exist or is not possible.
    """
    if clock.is_shared:
        if (requested or os.environ.get(VARIABLE)) == IN_PROCESS:
            raise InvalidValueError(
                f"transport {IN_PROCESS!r}: lock-step with other processes requires "
                f"{ZENOH!r}"
            )
        return ZENOH
    if requested is not None:
        return requested
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
    """Add the network to the graph's transports unless it is one of them already.

    Args:
        graph: the graph that joins the network.
        domain_id: separates systems on one network.
        now_ns: returns this process's time.
        lock_step: the clock of a lock-step with other processes, if there is one.

    Raises:
        InvalidValueError: the graph has joined another domain, or has nodes already.
        NetworkError: joining the network failed.
    """
    with graph.joining:
        _join(graph, domain_id, now_ns, lock_step)


def _join(
    graph: Graph,
    domain_id: int,
    now_ns: Callable[[], int],
    lock_step: LockStepClock | None,
) -> None:
    # Imported here, so that runs in process do not load Zenoh.
    from navette.transports.zenoh import ZenohTransport

    for transport in graph.transports:
        if isinstance(transport, ZenohTransport):
            if lock_step is not None:
                raise InvalidValueError(
                    "lock-step: only one context of a process can participate"
                )
            if transport.domain_id != domain_id:
                raise InvalidValueError(
                    f"domain {domain_id}: the programs of this process share the "
                    f"domain {transport.domain_id}"
                )
            return
    if graph.nodes():
        names = ", ".join(info.full_name for info in graph.nodes())
        raise InvalidValueError(
            f"cannot join the network: the graph has nodes already ({names})"
        )
    if lock_step is None:
        graph.add_transport(ZenohTransport(domain_id, now_ns))
        return
    from navette.transports.zenoh.lockstep import ZenohStepWire

    transport = ZenohTransport(domain_id, now_ns, traffic=lock_step.traffic)
    lock_step.join(ZenohStepWire(transport))
    graph.add_transport(transport)
