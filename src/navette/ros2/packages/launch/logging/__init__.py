"""ROS 2's ``launch.logging``: loggers for launch files."""

from navette.ros2.packages.launch.logging.loggers import (
    ConsoleHandler,
    console,
    get_logger,
    launch_config,
)

__all__ = ["ConsoleHandler", "console", "get_logger", "launch_config"]
