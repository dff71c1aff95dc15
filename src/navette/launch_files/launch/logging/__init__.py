"""ROS 2's ``launch.logging``: loggers for launch files."""

from navette.launch_files.launch.logging.loggers import (
    ConsoleHandler,
    get_logger,
    launch_config,
)

__all__ = ["ConsoleHandler", "get_logger", "launch_config"]
