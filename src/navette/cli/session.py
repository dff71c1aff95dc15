"""Connection of a verb to the running system: connect, wait, query the graph.

::

    with connect() as node:
        for endpoint in endpoints(node, "/map"):
            …
        if not wait_for(node, lambda: received, 5.0):
            fail("no message received")
"""

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Never

import click

from navette.cli.gc_tuning import collect
from navette.cli.interruption import (
    default_signal_action,
    ending_on_signals,
    interruptible,
)
from navette.cli.stderr import print_error
from navette.errors import CallbackError

if TYPE_CHECKING:
    from navette.runtime import Context, Node
    from navette.transports import Endpoint, EndpointKind

_EVERY_NODE_SERVES = {
    "describe_parameters",
    "get_parameter_types",
    "get_parameters",
    "get_type_description",
    "list_parameters",
    "set_parameters",
    "set_parameters_atomically",
}

FAILED = 1


@contextmanager
def connect(
    context: "Context | None" = None,
    *,
    node_name: str | None = None,
    run: str | None = None,
) -> "Iterator[Node]":
    """Yield a node connected to the network; its callbacks run in :func:`wait_for`.

    Ctrl-C and SIGTERM end the block with exit code 130 or 143. Exceptions of callbacks
    propagate unchanged.

    Args:
        context: context to use instead of a new one; it is not shut down.
        node_name: default: the hidden name ``_navette_<pid>``.
        run: the network to join, as ``NAVETTE_RUN`` names it, which is the default.
    """
    from navette.runtime import Executor, Node

    with ExitStack() as cleanup:
        if context is None:
            # Connecting and disconnecting need no cleanup on a signal.
            cleanup.enter_context(default_signal_action())
            with _named(run):
                context = _network_context()
            cleanup.callback(context.try_shutdown)
        node = Node(
            node_name or f"_navette_{os.getpid()}",
            context=context,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        cleanup.callback(node.destroy_node)
        executor = Executor(context=context)
        executor.add_node(node)
        collect()
        try:
            with ending_on_signals():
                yield node
        except CallbackError as error:
            # Unwrap errors of the verb's own callbacks: their location adds nothing.
            if isinstance(error.__cause__, Exception):
                raise error.__cause__ from None
            raise


def networks() -> list[str | None]:
    """Return all networks of this user's robots, as ``run`` of :func:`connect`."""
    from navette.files.runs import every_network

    return [None] if _has_transport() else [*every_network()]


def wait_for(
    node: "Node", condition: Callable[[], bool], timeout_s: float | None = None
) -> bool:
    """Run callbacks until the condition is true; return whether it is.

    Without a timeout only the condition or Ctrl-C ends the wait (with a virtual clock
    also the last event).
    """
    timeout_ns = None if timeout_s is None else round(timeout_s * 1e9)
    executor = node.executor

    def spin(is_interrupted: Callable[[], bool]) -> None:
        executor.spin_until_complete(
            lambda: is_interrupted() or condition(), timeout_ns
        )

    interruptible(spin, executor.wake)
    return condition()


def follow_clock(node: "Node") -> None:
    """Set the node's clock to simulated time (``/clock``)."""
    from navette.runtime import Parameter

    node.set_parameters([Parameter("use_sim_time", value=True)])


def is_simulated(node: "Node") -> bool:
    """Whether ``/clock`` has a publisher."""
    from navette.transports import EndpointKind

    return bool(endpoints(node, "/clock", kind=EndpointKind.PUBLISHER))


def endpoints(
    node: "Node", topic: str | None = None, *, kind: "EndpointKind | None" = None
) -> "list[Endpoint]":
    """Return the publishers and subscriptions of other nodes."""
    own = node.get_fully_qualified_name()
    found = node.context.graph.endpoints(topic, kind=kind)
    return [each for each in found if each.node_full_name != own]


def service_endpoints(
    node: "Node", service: str | None = None, *, kind: "EndpointKind | None" = None
) -> "list[Endpoint]":
    """Return the service servers and clients of other nodes."""
    own = node.get_fully_qualified_name()
    found = node.context.graph.service_endpoints(service, kind=kind)
    return [each for each in found if each.node_full_name != own]


def is_hidden(name: str) -> bool:
    """Whether the name is hidden as in ROS 2: a part begins with ``_``."""
    return any(token.startswith("_") for token in name.split("/"))


def is_of_every_node(service: str) -> bool:
    """Whether the service is a standard service of every node."""
    return service.rpartition("/")[2] in _EVERY_NODE_SERVES


def fail(message: str) -> Never:
    """Print an error and end the command with exit code 1."""
    print_error(message)
    raise click.exceptions.Exit(FAILED)


@contextmanager
def _named(run: str | None) -> Iterator[None]:
    """Inside, the environment names the run as ``--run`` does."""
    from navette.files.runs import VARIABLE

    before = os.environ.get(VARIABLE)
    if run is not None:
        os.environ[VARIABLE] = run
    try:
        yield
    finally:
        if run is not None and before is None:
            del os.environ[VARIABLE]
        elif before is not None:
            os.environ[VARIABLE] = before


def _has_transport() -> bool:
    """Whether something else than a run determines how programs communicate."""
    from navette.runtime.context import current_scope

    return "NAVETTE_TRANSPORT" in os.environ or current_scope.get().graph is not None


def _network_context() -> "Context":
    """Return a new context that logs only warnings and errors."""
    from navette.errors import NetworkError
    from navette.runtime import Context, LoggingSeverity, SystemClock

    transport = None if _has_transport() else "zenoh"
    context = Context(clock=SystemClock(), transport=transport)
    try:
        context.init(args=[], console_level=LoggingSeverity.WARN)
    except NetworkError as error:
        fail(str(error))
    return context
