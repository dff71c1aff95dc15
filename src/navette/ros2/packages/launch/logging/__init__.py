"""ROS 2's ``launch.logging``: loggers, formats and log files of launches."""

from navette.ros2.packages.launch.logging import handlers
from navette.ros2.packages.launch.logging.config import LaunchConfig, launch_config
from navette.ros2.packages.launch.logging.console import (
    ConsoleHandler,
    console,
    get_logger,
    reset,
)
from navette.ros2.packages.launch.logging.outputs import (
    get_output_loggers,
    output_places,
)

__all__ = [
    "ConsoleHandler",
    "LaunchConfig",
    "console",
    "get_logger",
    "get_output_loggers",
    "handlers",
    "launch_config",
    "output_places",
    "reset",
]
