"""Executors: rclpy's names for the one deterministic loop."""

from navette.runtime.exceptions import (
    ExternalShutdownException,
    ShutdownException,
    TimeoutException,
)
from navette.runtime.executor import (
    Executor,
    MultiThreadedExecutor,
    SingleThreadedExecutor,
    await_or_execute,
)

__all__ = [
    "Executor",
    "ExternalShutdownException",
    "MultiThreadedExecutor",
    "ShutdownException",
    "SingleThreadedExecutor",
    "TimeoutException",
    "await_or_execute",
]
