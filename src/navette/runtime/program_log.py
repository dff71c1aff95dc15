"""Loggers without a node: ``rclpy.logging``.

A message belongs to the context that is the default one when it is logged. Before that
context is initialised, messages go to the console.
"""

from navette.runtime.context import get_default_context
from navette.runtime.log import Logger, LogHub
from navette.runtime.log_levels import LoggingSeverity, severity_from_string
from navette.runtime.log_sinks import ConsoleSink

_console = ConsoleSink()


class ProgramLogger(Logger):
    """A logger that looks the default context's hub up for each message."""

    def __init__(self, name: str) -> None:
        super().__init__(name, program_hub())

    @property
    def _hub(self) -> LogHub:
        return program_hub()

    @_hub.setter
    def _hub(self, hub: LogHub) -> None:
        """Ignore the hub that the base class assigns."""

    def get_child(self, name: str) -> "ProgramLogger":
        if not name:
            raise ValueError("child logger name must not be empty")
        return ProgramLogger(f"{self.name}.{name}" if self.name else name)


def program_hub() -> LogHub:
    """Return the hub of the default context."""
    context = get_default_context()
    has_begun = context.ok() or context.was_shut_down
    context.log.fallback = None if has_begun else _console
    return context.log


def get_logger(name: str) -> ProgramLogger:
    """Return the logger of that name; raise ValueError if the name is empty."""
    if not name:
        raise ValueError("logger name must not be empty")
    return ProgramLogger(name)


def set_logger_level(
    name: str, level: int | LoggingSeverity, detailed_error: bool = False
) -> None:
    """Set the level of a logger and its children; see :meth:`LogHub.set_level`."""
    program_hub().set_level(name, level)


def get_logger_level(name: str) -> LoggingSeverity:
    """Return the level of this logger itself, UNSET if it inherits."""
    return program_hub().get_level(name)


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return the logger's own level or that of its nearest parent with one."""
    return program_hub().effective_level(name)


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Return the severity of a name such as ``info``."""
    return severity_from_string(log_severity)


def initialize() -> None:
    """Set up logging for the default context."""
    program_hub()


def clear_config() -> None:
    """Reset all loggers to their default levels."""
    program_hub().reset_levels()


def shutdown() -> None:
    """Reset all loggers, as :func:`clear_config` does."""
    clear_config()
