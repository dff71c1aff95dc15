"""ROS 2's ``launch.event_handlers``."""

from navette.ros2.packages.launch.event_handlers.on_launch import (
    OnIncludeLaunchDescription,
    OnShutdown,
    event_named,
)
from navette.ros2.packages.launch.event_handlers.on_process import (
    OnActionEventBase,
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
)

__all__ = [
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnIncludeLaunchDescription",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
    "event_named",
]
