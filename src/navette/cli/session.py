"""Looking in from outside: how a verb joins what runs, waits, and leaves.

::

    with connect() as node:
        for endpoint in endpoints(node, "/map"):
            …
        if not wait_for(node, lambda: something_came, 5.0):
            fail("nothing came")
"""

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Never

import click

from navette.cli.gc_tuning import collect
from navette.cli.interruption import (
    dying_on_signals,
    ending_on_signals,
    interruptible,
)
from navette.cli.stderr import complain
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
    context: "Context | None" = None, *, node_name: str | None = None
) -> "Iterator[Node]":
    """A node of this process that sees all that runs; its callbacks run in waits.

    Ctrl-C and SIGTERM inside end the command with exit code 130 or 143; what a
    callback raises comes out as it was raised.

    Args:
        context: where to look instead of on the network; stays open.
        node_name: by default ``_navette_<pid>``, which listings leave out.
    """
    from navette.runtime import Executor, Node

    with ExitStack() as leaving:
        if context is None:
            # Nothing is to be cleaned up while it joins, and nothing should wait for
            # the network to hear of it when it leaves.
            leaving.enter_context(dying_on_signals())
            joined = _outside()
            leaving.callback(joined.try_shutdown)
        else:
            joined = context
        node = Node(
            node_name or f"_navette_{os.getpid()}",
            context=joined,
            use_global_arguments=False,
            enable_rosout=False,
            start_parameter_services=False,
        )
        leaving.callback(node.destroy_node)
        executor = Executor(context=joined)
        executor.add_node(node)
        collect()
        try:
            with ending_on_signals():
                yield node
        except CallbackError as error:
            # The verb's own callbacks: where they hang is no news to anybody.
            if isinstance(error.__cause__, Exception):
                raise error.__cause__ from None
            raise


def wait_for(
    node: "Node", condition: Callable[[], bool], timeout_s: float | None = None
) -> bool:
    """Let events run until the condition holds; tells whether it does.

    Without a timeout it ends only so, or by Ctrl-C (under a virtual clock also when
    nothing is left to happen).
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
    """Let the node's clock tell simulated time, that of ``/clock``."""
    from navette.runtime import Parameter

    node.set_parameters([Parameter("use_sim_time", value=True)])


def is_simulated(node: "Node") -> bool:
    """Whether somebody publishes ``/clock``."""
    from navette.transports import EndpointKind

    return bool(endpoints(node, "/clock", kind=EndpointKind.PUBLISHER))


def endpoints(
    node: "Node", topic: str | None = None, *, kind: "EndpointKind | None" = None
) -> "list[Endpoint]":
    """Publishers and subscriptions that run; not those of ``node`` itself."""
    own = node.get_fully_qualified_name()
    found = node.context.graph.endpoints(topic, kind=kind)
    return [each for each in found if each.node_full_name != own]


def service_endpoints(
    node: "Node", service: str | None = None, *, kind: "EndpointKind | None" = None
) -> "list[Endpoint]":
    """Servers and clients that run; not those of ``node`` itself."""
    own = node.get_fully_qualified_name()
    found = node.context.graph.service_endpoints(service, kind=kind)
    return [each for each in found if each.node_full_name != own]


def is_hidden(name: str) -> bool:
    """Whether a topic's, service's or node's name is for machines, as ROS 2 says."""
    return any(token.startswith("_") for token in name.split("/"))


def is_of_every_node(service: str) -> bool:
    """Whether it is one of the services that every node has."""
    return service.rpartition("/")[2] in _EVERY_NODE_SERVES


def fail(message: str) -> Never:
    """End the command: what was asked for failed (exit code 1)."""
    complain(message)
    raise click.exceptions.Exit(FAILED)


def _outside() -> "Context":
    """A context of its own that says on standard error only what went wrong."""
    from navette.errors import NetworkError
    from navette.runtime import Context, LoggingSeverity, SystemClock
    from navette.runtime.context import current_scope

    is_set = "NAVETTE_TRANSPORT" in os.environ or current_scope.get().graph is not None
    context = Context(clock=SystemClock(), transport=None if is_set else "zenoh")
    try:
        context.init(args=[], console_level=LoggingSeverity.WARN)
    except NetworkError as error:
        fail(str(error))
    return context
