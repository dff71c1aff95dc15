"""Choice of a context's transports: in process only, or also the network."""

import logging
import os
import socket
from dataclasses import dataclass

from navette.errors import InvalidValueError
from navette.files.runs import SHARED, RunInfo, chosen_run, named_run
from navette.files.runs import VARIABLE as RUN_VARIABLE
from navette.runtime.clock import ContextClock, PacedClock, VirtualClock
from navette.runtime.graph import Graph
from navette.runtime.lockstep import LockStepClock
from navette.transports.clock import NanosecondClock

_log = logging.getLogger(__name__)

IN_PROCESS, ZENOH = "inprocess", "zenoh"
TRANSPORTS = (IN_PROCESS, ZENOH)
VARIABLE = "NAVETTE_TRANSPORT"


def checked_transport(name: str, source: str) -> str:
    """Return the name of a transport.

    Raises:
        InvalidValueError: unknown transport; lists the existing ones.
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


@dataclass(frozen=True)
class Membership:
    """The network that a graph has joined.

    Attributes:
        domain_id: separates systems on one network.
        run: the private run; None: the shared network.
    """

    domain_id: int
    run: RunInfo | None = None


def join_network(
    graph: Graph,
    clock: NanosecondClock,
    *,
    domain_id: int | None = None,
    own_run: RunInfo | None = None,
    named_only: bool = False,
    lock_step: LockStepClock | None = None,
) -> Membership:
    """Add the network to the graph's transports unless it is one of them already.

    Args:
        graph: the graph that joins the network.
        clock: this process's time.
        domain_id: default: that of the run, else of ``ROS_DOMAIN_ID``.
        own_run: the run of this process; None: the run that the program is to join, or
            the shared network (:func:`navette.files.runs.chosen_run`).
        named_only: join a run only if ``NAVETTE_RUN`` names it.
        lock_step: the clock of a lock-step with other processes, if there is one.

    Raises:
        InvalidValueError: the graph has joined another domain, or has nodes already.
        NetworkError: joining the network failed, or the choice of a run.
    """
    # Imported here, so that runs in process do not load Zenoh.
    from navette.transports.zenoh import Settings, ZenohTransport

    with graph.joining:
        for transport in graph.transports:
            if isinstance(transport, ZenohTransport):
                _check_second(transport.domain_id, domain_id, lock_step)
                return Membership(transport.domain_id)
        if graph.nodes():
            names = ", ".join(info.full_name for info in graph.nodes())
            raise InvalidValueError(
                f"cannot join the network: the graph has nodes already ({names})"
            )
        run = own_run or chosen_run(named_only=named_only or domain_id is not None)
        if run is not None and own_run is None and not named_run():
            _warn_of_shared_network(run)
        if domain_id is None:
            domain_id = environment_domain() if run is None else run.domain
        settings = Settings.from_environment()
        if run is not None:
            settings = settings.within(run.router, run.new_endpoint())
        if lock_step is None:
            graph.add_transport(ZenohTransport(domain_id, clock, settings))
            return Membership(domain_id, run)
        from navette.transports.zenoh.lockstep import ZenohStepWire

        traffic = lock_step.traffic
        stepped = ZenohTransport(domain_id, clock, settings, traffic=traffic)
        lock_step.join(ZenohStepWire(stepped))
        graph.add_transport(stepped)
        return Membership(domain_id, run)


def environment_domain() -> int:
    """Return ``ROS_DOMAIN_ID``, 0 by default.

    Raises:
        InvalidValueError: the variable is not a number.
    """
    text = os.environ.get("ROS_DOMAIN_ID", "0") or "0"
    if not text.isdigit():
        raise InvalidValueError(f"ROS_DOMAIN_ID must be a number >= 0, got {text!r}")
    return int(text)


def _warn_of_shared_network(joined: RunInfo) -> None:
    """Warn if programs outside the joined run may have been meant."""
    from navette.transports.zenoh.settings import DEFAULT_ROUTER

    address, _, port = DEFAULT_ROUTER.partition("/")[2].partition(":")
    with socket.socket() as probe:
        if os.name == "posix":  # only a listening socket is in the way
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((address, int(port)))
        except OSError:
            _log.warning(
                "joined run %s; programs outside of it are running too: --run %s (or "
                "%s=%s) joins those",
                joined.name,
                SHARED,
                RUN_VARIABLE,
                SHARED,
            )


def _check_second(
    joined: int, domain_id: int | None, lock_step: LockStepClock | None
) -> None:
    """Check that another context of the process may use the same session."""
    if lock_step is not None:
        raise InvalidValueError(
            "lock-step: only one context of a process can participate"
        )
    if domain_id not in (None, joined):
        raise InvalidValueError(
            f"domain {domain_id}: the programs of this process share the domain "
            f"{joined}"
        )
