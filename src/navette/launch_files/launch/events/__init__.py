"""ROS 2's ``launch.events``."""

from navette.launch_files.launch.events import process
from navette.launch_files.launch.events.execution import (
    ExecutionComplete,
    IncludeLaunchDescription,
    TimerEvent,
    matches_action,
)
from navette.launch_files.launch.events.shutdown import Shutdown

__all__ = [
    "ExecutionComplete",
    "IncludeLaunchDescription",
    "Shutdown",
    "TimerEvent",
    "matches_action",
    "process",
]
