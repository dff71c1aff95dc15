"""Navette's ``launch.logging``."""

from navette.launch_files.launch.logging import (
    ConsoleHandler,
    get_logger,
    launch_config,
)

__all__ = ["ConsoleHandler", "get_logger", "launch_config"]
