"""Executors: rclpy's names for the one deterministic loop."""

from navette.runtime import (
    Client,
    Clock,
    ClockType,
    Context,
    Service,
    Subscription,
    Timer,
    get_default_context,
)
from navette.runtime.exceptions import (
    ConditionReachedException,
    ExternalShutdownException,
    InvalidHandle,
    ShutdownException,
    TimeoutException,
)
from navette.runtime.executor import (
    Executor,
    MultiThreadedExecutor,
    SingleThreadedExecutor,
    TimeoutObject,
    await_or_execute,
)
from navette.runtime.future import Future, Task
from navette.runtime.guard_condition import GuardCondition
from navette.runtime.node import Node
from navette.runtime.signals import SignalHandlerGuardCondition
from navette.runtime.time import timeout_sec_to_nsec
from navette.runtime.timer import TimerInfo
from navette.runtime.wait_set import NumberOfEntities
from navette.runtime.waitable import Waitable

__all__ = [
    "Client",
    "Clock",
    "ClockType",
    "ConditionReachedException",
    "Context",
    "Executor",
    "ExternalShutdownException",
    "Future",
    "GuardCondition",
    "InvalidHandle",
    "MultiThreadedExecutor",
    "Node",
    "NumberOfEntities",
    "Service",
    "ShutdownException",
    "SignalHandlerGuardCondition",
    "SingleThreadedExecutor",
    "Subscription",
    "Task",
    "TimeoutException",
    "TimeoutObject",
    "Timer",
    "TimerInfo",
    "Waitable",
    "await_or_execute",
    "get_default_context",
    "timeout_sec_to_nsec",
]
