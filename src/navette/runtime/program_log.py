"""Loggers of the program, without a node: rclpy's ``rclpy.logging``.

They belong to whatever context is the default one when a line is logged. Before that is
initialised, lines go to the console.
"""

import os
from pathlib import Path

from navette.runtime.context import get_default_context
from navette.runtime.log import Logger, LogHub
from navette.runtime.log_levels import LoggingSeverity, severity_from_string
from navette.runtime.log_sinks import ConsoleSink

_console = ConsoleSink()


class ProgramLogger(Logger):
    """A logger that finds its context's hub anew for each line."""

    def __init__(self, name: str) -> None:
        super().__init__(name, program_hub())

    @property
    def _hub(self) -> LogHub:
        return program_hub()

    @_hub.setter
    def _hub(self, hub: LogHub) -> None:
        """The base class keeps one; here it is looked up."""

    def get_child(self, name: str) -> "ProgramLogger":
        if not name:
            raise ValueError("child logger name must not be empty")
        return ProgramLogger(f"{self.name}.{name}" if self.name else name)


def program_hub() -> LogHub:
    """Where the lines of the default context go."""
    context = get_default_context()
    has_begun = context.ok() or context.was_shut_down
    context.log.fallback = None if has_begun else _console
    return context.log


def get_logger(name: str) -> ProgramLogger:
    """A logger of that name; raises ValueError if it is empty."""
    if not name:
        raise ValueError("logger name must not be empty")
    return ProgramLogger(name)


def set_logger_level(
    name: str, level: int | LoggingSeverity, detailed_error: bool = False
) -> None:
    """Level of a logger and its children; "" is all, UNSET inherits again."""
    program_hub().set_level(name, level)


def get_logger_level(name: str) -> LoggingSeverity:
    """The level set for exactly this logger."""
    return program_hub().get_level(name)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """The level that counts: its own or the nearest parent's."""
    return program_hub().effective_level(name)


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """``info`` → INFO, in any case; raises InvalidValueError with the known names."""
    return severity_from_string(log_severity)


def get_logging_directory() -> Path:
    """Where ROS 2 programs write their logs: ROS_LOG_DIR, ROS_HOME/log, ~/.ros/log."""
    directory = os.environ.get("ROS_LOG_DIR")
    if directory:
        return Path(directory).expanduser()
    home = os.environ.get("ROS_HOME") or "~/.ros"
    return Path(home).expanduser() / "log"


def initialize() -> None:
    """Nothing to prepare: the first line that is logged finds its way."""
    program_hub()


def clear_config() -> None:
    """All loggers at their default levels again."""
    program_hub().reset_levels()


def shutdown() -> None:
    """As :func:`clear_config`."""
    clear_config()
