"""Loggers of launches, and their output on the terminal in ROS 2's format."""

import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from navette.ros2.packages.launch.logging.config import launch_config
from navette.ros2.packages.launch.logging.formats import ROOT


def get_logger(name: str | None = None) -> logging.Logger:
    """Return the logger of a launch file or action."""
    return logging.getLogger(f"{ROOT}.{name}" if name else ROOT)


def reset() -> None:
    """Restore the defaults of all loggers of launches."""
    launch_config.reset()
    for name in [ROOT, *logging.root.manager.loggerDict]:
        if name == ROOT or name.startswith(f"{ROOT}."):
            logger = logging.getLogger(name)
            for handler in tuple(logger.handlers):
                logger.removeHandler(handler)
            if name != ROOT:
                logger.setLevel(logging.NOTSET)
                logger.propagate = True


class ConsoleHandler(logging.Handler):
    """Prints ``[INFO] [launch]: …``; warnings and errors on the standard error."""

    def __init__(
        self, stdout: TextIO | None = None, stderr: TextIO | None = None
    ) -> None:
        super().__init__()
        self._stdout = stdout
        self._stderr = stderr
        self.setFormatter(launch_config.screen_formatter)

    def emit(self, record: logging.LogRecord) -> None:
        if record.levelno >= logging.WARNING:
            stream = self._stderr or sys.stderr
        else:
            stream = self._stdout or sys.stdout
        stream.write(self.format(record) + "\n")
        stream.flush()


@contextmanager
def console(*, debug: bool) -> Iterator[None]:
    """Print the log of launches while the block runs."""
    logger = get_logger()
    handler = ConsoleHandler()
    before = logger.level, logger.propagate
    logger.addHandler(handler)
    if debug:
        logger.setLevel(logging.DEBUG)
    logger.propagate = False
    try:
        yield
    finally:
        logger.removeHandler(handler)
        logger.setLevel(before[0])
        logger.propagate = before[1]
