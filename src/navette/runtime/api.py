"""rclpy's module-level functions: init, spin, shutdown and others."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from navette.runtime.arguments import remove_ros_args as _remove_ros_args
from navette.runtime.clock import ContextClock
from navette.runtime.context import (
    Context,
    get_default_context,
    reset_default_context,
)
from navette.runtime.executor import Executor, SingleThreadedExecutor
from navette.runtime.future import Future
from navette.runtime.node import Node
from navette.runtime.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
)


class InitContextManager:
    """Result of :func:`init`; ``with init(): …`` shuts down at the end."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> "InitContextManager":
        return self

    def __exit__(self, *exc_info: object) -> None:
        is_default = self.context is get_default_context()
        try_shutdown(context=self.context, uninstall_handlers=is_default)


def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
    clock: ContextClock | None = None,
) -> InitContextManager:
    """Initialise the context with ``args`` (``sys.argv`` if None).

    Args:
        signal_handler_options: default: all for the default context, otherwise none.
        clock: how time passes (default: the system clock).
    """
    if context is None:
        if signal_handler_options is None:
            signal_handler_options = SignalHandlerOptions.ALL
        # A context that was shut down cannot be reused.
        context = get_default_context()
        if context.was_shut_down:
            reset_default_context()
            context = get_default_context()
    if clock is not None:
        context.use_clock(clock)
    context.init(args, domain_id=domain_id)
    if signal_handler_options is not None:
        install_signal_handlers(signal_handler_options)
    return InitContextManager(context)


def ok(*, context: Context | None = None) -> bool:
    """Return whether the context is initialised and not shut down."""
    return (context or get_default_context()).ok()


def shutdown(
    *, context: Context | None = None, uninstall_handlers: bool | None = None
) -> None:
    """Shut the context down: destroy its nodes and end its spins.

    Without effect after a shutdown by a signal.

    Args:
        uninstall_handlers: whether to remove the signal handlers; default: only for
            the default context.

    Raises:
        RCLError: the program has shut the context down before.
    """
    (context or get_default_context()).shutdown()
    if uninstall_handlers is None:
        uninstall_handlers = context is None
    if uninstall_handlers:
        uninstall_signal_handlers()


def try_shutdown(
    *, context: Context | None = None, uninstall_handlers: bool | None = None
) -> None:
    """Shut down if the context is valid."""
    if ok(context=context):
        shutdown(context=context, uninstall_handlers=uninstall_handlers)


def create_node(node_name: str, **kwargs: Any) -> Node:
    """Create a :class:`Node` with its keyword arguments."""
    return Node(node_name, **kwargs)


def get_global_executor(context: Context | None = None) -> Executor:
    """Return the executor of :func:`spin`; each context has one."""
    context = context or get_default_context()
    if context.executor is None:
        context.executor = SingleThreadedExecutor(context=context)
    executor: Executor = context.executor
    return executor


def _executor_of(node: Node) -> Executor:
    if not isinstance(node, Node):
        raise TypeError(f"node must be a Node, got {node!r}")
    executor: Executor | None = node.executor
    return executor or get_global_executor(node.context)


@contextmanager
def _executor_with(node: Node, executor: Executor | None) -> Iterator[Executor]:
    """Add the node to its executor for the duration of a spin."""
    executor = executor or _executor_of(node)
    was_added = executor.add_node(node)
    try:
        yield executor
    finally:
        if was_added:
            executor.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run the node's callbacks until shutdown."""
    with _executor_with(node, executor) as used:
        used.spin()


def spin_once(
    node: Node,
    *,
    executor: Executor | None = None,
    timeout_sec: float | None = None,
) -> None:
    """Run one event, waiting at most ``timeout_sec`` for it."""
    with _executor_with(node, executor) as used:
        used.spin_once(timeout_sec=timeout_sec)


def spin_until_future_complete(
    node: Node,
    future: Future[Any],
    executor: Executor | None = None,
    timeout_sec: float | None = None,
) -> None:
    """Run until ``future`` is done or the timeout expires; also in a callback."""
    with _executor_with(node, executor) as used:
        used.spin_until_future_complete(future, timeout_sec)


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Return ``args`` (``sys.argv`` if None) without the ROS arguments."""
    return _remove_ros_args(sys.argv if args is None else args)
