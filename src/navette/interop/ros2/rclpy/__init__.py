"""rclpy's own functions."""

from navette.runtime import (
    Context,
    InitContextManager,
    Parameter,
    SignalHandlerOptions,
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
from navette.runtime.future import Future

__all__ = [
    "Context",
    "Future",
    "InitContextManager",
    "Parameter",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "init",
    "ok",
    "remove_ros_args",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
]
