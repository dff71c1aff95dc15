"""ROS 2's ``launch.events``."""

from navette.ros2.packages.launch.event import ExecutionComplete
from navette.ros2.packages.launch.events import process
from navette.ros2.packages.launch.events.execution import (
    IncludeLaunchDescription,
    Shutdown,
    TimerEvent,
    matches_action,
)

__all__ = [
    "ExecutionComplete",
    "IncludeLaunchDescription",
    "Shutdown",
    "TimerEvent",
    "matches_action",
    "process",
]
