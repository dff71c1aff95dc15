"""rclpy's own functions."""

from navette.runtime import (
    Context,
    InitContextManager,
    Node,
    Parameter,
    SignalHandlerOptions,
    SingleThreadedExecutor,
    create_node,
    get_default_context,
    get_global_executor,
    init,
    ok,
    remove_ros_args,
    shutdown,
    spin,
    spin_once,
    spin_until_future_complete,
    try_shutdown,
)
from navette.runtime.executor import Executor
from navette.runtime.future import Future
from navette.runtime.rmw import (
    get_available_rmw_implementations,
    get_rmw_implementation_identifier,
)
from navette.runtime.signals import install_signal_handlers, uninstall_signal_handlers

__all__ = [
    "Context",
    "Executor",
    "Future",
    "InitContextManager",
    "Node",
    "Parameter",
    "SignalHandlerOptions",
    "SingleThreadedExecutor",
    "create_node",
    "get_available_rmw_implementations",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "install_signal_handlers",
    "ok",
    "remove_ros_args",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
    "uninstall_signal_handlers",
]
