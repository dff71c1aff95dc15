"""ROS 2's ``launch.events``."""

from navette.ros2.packages.launch.events import process
from navette.ros2.packages.launch.events.execution import (
    ExecutionComplete,
    IncludeLaunchDescription,
    TimerEvent,
    matches_action,
)
from navette.ros2.packages.launch.events.shutdown import Shutdown

__all__ = [
    "ExecutionComplete",
    "IncludeLaunchDescription",
    "Shutdown",
    "TimerEvent",
    "matches_action",
    "process",
]
