"""The node runtime: rclpy's API on one deterministic executor.

Rarely used parts (actions, lifecycle nodes, …) are imported on first use.
"""

from typing import TYPE_CHECKING, Any

from navette.runtime.api import (
    InitContextManager,
    create_node,
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
from navette.runtime.callback_groups import (
    CallbackGroup,
    MutuallyExclusiveCallbackGroup,
    ReentrantCallbackGroup,
)
from navette.runtime.client import Client
from navette.runtime.clock import (
    ContextClock,
    PacedClock,
    Stopwatch,
    SystemClock,
    VirtualClock,
)
from navette.runtime.context import Context, get_default_context
from navette.runtime.exceptions import (
    ExternalShutdownException,
    NotInitializedException,
    ParameterAlreadyDeclaredException,
    ParameterNotDeclaredException,
    ROSInterruptException,
)
from navette.runtime.executor import (
    Executor,
    MultiThreadedExecutor,
    SingleThreadedExecutor,
)
from navette.runtime.future import Future, Task
from navette.runtime.graph import Graph
from navette.runtime.log import Logger
from navette.runtime.log_levels import LoggingSeverity
from navette.runtime.node import Node
from navette.runtime.parameter import Parameter
from navette.runtime.publisher import Publisher
from navette.runtime.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
    qos_profile_system_default,
)
from navette.runtime.rate import Rate
from navette.runtime.ros_clock import Clock, JumpThreshold, ROSClock, TimeJump
from navette.runtime.service import Service
from navette.runtime.signals import SignalHandlerOptions
from navette.runtime.subscription import MessageInfo, Subscription
from navette.runtime.time import (
    ClockType,
    Duration,
    Time,
    ns_to_stamp,
    stamp_to_ns,
)
from navette.runtime.timer import Timer
from navette.transports import Endpoint, NodeInfo

if TYPE_CHECKING:
    from navette.runtime.action import (
        ActionClient,
        ActionServer,
        CancelResponse,
        GoalResponse,
    )
    from navette.runtime.lifecycle import (
        LifecycleNode,
        LifecyclePublisher,
        TransitionCallbackReturn,
    )
    from navette.runtime.parameter_client import AsyncParameterClient
    from navette.runtime.parameter_event_handler import ParameterEventHandler
    from navette.runtime.parameter_files import read_parameter_file
    from navette.runtime.serialization import deserialize_message, serialize_message
    from navette.runtime.stage.params import declare_params
    from navette.runtime.stage.stage_node import Input, Output, StageNode
    from navette.runtime.stage.status import StatusReporter, status_output
    from navette.runtime.tf import (
        Buffer,
        StaticTransformBroadcaster,
        TransformBroadcaster,
        TransformListener,
    )

__all__ = [
    # life cycle
    "Context",
    "InitContextManager",
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
    # nodes, topics and services
    "deserialize_message",
    "serialize_message",
    "Client",
    "Endpoint",
    "Graph",
    "MessageInfo",
    "Node",
    "NodeInfo",
    "Publisher",
    "Service",
    "Subscription",
    "DurabilityPolicy",
    "HistoryPolicy",
    "LivelinessPolicy",
    "QoSPresetProfiles",
    "QoSProfile",
    "ReliabilityPolicy",
    "qos_profile_sensor_data",
    "qos_profile_system_default",
    # actions
    "ActionClient",
    "ActionServer",
    "CancelResponse",
    "GoalResponse",
    # managed nodes
    "LifecycleNode",
    "LifecyclePublisher",
    "TransitionCallbackReturn",
    # execution
    "CallbackGroup",
    "Executor",
    "Future",
    "MultiThreadedExecutor",
    "MutuallyExclusiveCallbackGroup",
    "ReentrantCallbackGroup",
    "SingleThreadedExecutor",
    "Task",
    # time
    "Clock",
    "ClockType",
    "Duration",
    "JumpThreshold",
    "PacedClock",
    "ROSClock",
    "Rate",
    "Stopwatch",
    "SystemClock",
    "Time",
    "TimeJump",
    "ContextClock",
    "Timer",
    "VirtualClock",
    "ns_to_stamp",
    "stamp_to_ns",
    # parameters and logging
    "AsyncParameterClient",
    "Logger",
    "LoggingSeverity",
    "Parameter",
    "ParameterEventHandler",
    "declare_params",
    "read_parameter_file",
    # stages
    "Input",
    "Output",
    "StageNode",
    "StatusReporter",
    "status_output",
    # transforms
    "Buffer",
    "StaticTransformBroadcaster",
    "TransformBroadcaster",
    "TransformListener",
    # errors
    "ExternalShutdownException",
    "NotInitializedException",
    "ParameterAlreadyDeclaredException",
    "ParameterNotDeclaredException",
    "ROSInterruptException",
]


def __getattr__(name: str) -> Any:
    """Import a rarely used name."""
    from navette.runtime.lazy_exports import find

    value = globals()[name] = find(name)
    return value
