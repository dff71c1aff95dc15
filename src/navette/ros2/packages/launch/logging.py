"""Loggers of launches, printed in ROS 2's format."""

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

__all__ = ["ConsoleHandler", "console", "get_logger", "launch_config"]

ROOT = "navette.launch"
DATE_AND_NAME = "[%(levelname)s] [%(launch_name)s]: %(message)s"


def get_logger(name: str | None = None) -> logging.Logger:
    """Return the logger of a launch file or action."""
    return logging.getLogger(f"{ROOT}.{name}" if name else ROOT)


class ConsoleHandler(logging.Handler):
    """Prints ``[INFO] [launch]: …``; warnings and errors on the standard error."""

    def __init__(
        self, stdout: TextIO | None = None, stderr: TextIO | None = None
    ) -> None:
        super().__init__()
        self._stdout = stdout
        self._stderr = stderr
        self.setFormatter(logging.Formatter(DATE_AND_NAME))

    def emit(self, record: logging.LogRecord) -> None:
        record.launch_name = record.name.removeprefix(f"{ROOT}.")
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
    logger.setLevel(logging.DEBUG if debug else logging.INFO)
    logger.propagate = False
    try:
        yield
    finally:
        logger.removeHandler(handler)
        logger.level, logger.propagate = before


class LaunchConfig:
    """Folder and level of logs: ``launch.logging.launch_config``."""

    @property
    def level(self) -> int:
        return logging.getLogger(ROOT).level

    @level.setter
    def level(self, level: int | str) -> None:
        logging.getLogger(ROOT).setLevel(
            level.upper() if isinstance(level, str) else level
        )

    @property
    def log_dir(self) -> str:
        """``ROS_LOG_DIR``, ``ROS_HOME/log`` or ``~/.ros/log``."""
        given = os.environ.get("ROS_LOG_DIR")
        if given:
            return str(Path(given).expanduser())
        home = os.environ.get("ROS_HOME") or "~/.ros"
        return str(Path(home).expanduser() / "log")

    @log_dir.setter
    def log_dir(self, folder: str) -> None:
        os.environ["ROS_LOG_DIR"] = folder


launch_config = LaunchConfig()
