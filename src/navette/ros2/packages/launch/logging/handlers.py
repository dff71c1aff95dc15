"""Handlers of log records that format the records of some loggers differently."""

import logging
import sys
from typing import Any

__all__ = ["FileHandler", "Handler", "StreamHandler"]


class _FormatsByLogger(logging.Handler):
    """Handler with a formatter for each of some loggers."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._formatters: dict[str, logging.Formatter] = {}

    def setFormatterFor(  # noqa: N802 - ROS 2's name
        self, logger: logging.Logger, formatter: logging.Formatter
    ) -> None:
        """Use a formatter for the records of one logger."""
        self._formatters[logger.name] = formatter

    def unsetFormatterFor(self, logger: logging.Logger) -> None:  # noqa: N802 - ROS 2's name
        """Use the common formatter for the records of a logger again."""
        self._formatters.pop(logger.name, None)

    def format(self, record: logging.LogRecord) -> str:
        formatter = self._formatters.get(record.name)
        return super().format(record) if formatter is None else formatter.format(record)


class Handler(_FormatsByLogger):
    """Base class of handlers; programs derive theirs from it."""


class StreamHandler(_FormatsByLogger, logging.StreamHandler[Any]):
    """Handler that writes to a stream."""


class FileHandler(_FormatsByLogger, logging.FileHandler):
    """Handler that appends to a file, which is created by the first record."""


class ScreenHandler(Handler):
    """Handler that writes to the standard output of the moment."""

    def emit(self, record: logging.LogRecord) -> None:
        sys.stdout.write(self.format(record) + "\n")
        sys.stdout.flush()
