"""Folder, level, formats and handlers of the logs of launches."""

import logging
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from navette.ros2.packages.launch.logging.formats import (
    LOG_FORMATS,
    ROOT,
    SCREEN_FORMATS,
    LaunchFormatter,
    make_formatter,
)
from navette.ros2.packages.launch.logging.handlers import FileHandler, ScreenHandler

LOG_FILE = "launch.log"
HandlerFactory = Callable[..., Any]


def _open_file(path: str, encoding: str | None = None) -> FileHandler:
    return FileHandler(path, encoding=encoding)


class LaunchConfig:
    """Settings of all logs of launches: ``launch.logging.launch_config``.

    The environment variables ``OVERRIDE_LAUNCH_SCREEN_FORMAT`` and
    ``OVERRIDE_LAUNCH_LOG_FORMAT`` precede formats that programs set.
    """

    def __init__(self) -> None:
        self._handlers: dict[str, Any] = {}
        self.reset()

    def reset(self) -> None:
        """Restore the defaults; close the log files."""
        for handler in self._handlers.values():
            handler.close()
        self._handlers = {}
        self._log_dir: str | None = None
        self._screen_handler: ScreenHandler | None = None
        self.log_handler_factory: HandlerFactory = _open_file
        self.level = logging.INFO
        self.set_screen_format("default")
        self.set_log_format("default")

    @property
    def level(self) -> int:
        """Lowest level of the records that are logged."""
        return logging.getLogger(ROOT).level

    @level.setter
    def level(self, level: int | str) -> None:
        logging.getLogger(ROOT).setLevel(
            level.upper() if isinstance(level, str) else level
        )

    @property
    def log_dir(self) -> str:
        """The set folder, ``ROS_LOG_DIR``, ``ROS_HOME/log`` or ``~/.ros/log``."""
        if self._log_dir is not None:
            return self._log_dir
        given = os.environ.get("ROS_LOG_DIR")
        if given:
            return str(Path(given).expanduser())
        home = os.environ.get("ROS_HOME") or "~/.ros"
        return str(Path(home).expanduser() / "log")

    @log_dir.setter
    def log_dir(self, folder: str | None) -> None:
        if folder and not Path(folder).expanduser().is_dir():
            raise ValueError(f"log_dir {folder!r}: no such folder")
        self._log_dir = str(Path(folder).expanduser()) if folder else None

    def set_screen_format(
        self, screen_format: str, *, screen_style: str | None = None
    ) -> None:
        """Set the format of records on the terminal.

        Args:
            screen_format: ``default``, ``default_with_timestamp`` or a format string.
            screen_style: style of a format string: ``%``, ``{`` (default) or ``$``.
        """
        text = os.environ.get("OVERRIDE_LAUNCH_SCREEN_FORMAT") or screen_format
        self._screen_formatter = make_formatter(text, screen_style, SCREEN_FORMATS)
        if self._screen_handler is not None:
            self._screen_handler.setFormatter(self._screen_formatter)

    def set_log_format(self, log_format: str, *, log_style: str | None = None) -> None:
        """Set the format of records in log files; see :meth:`set_screen_format`."""
        text = os.environ.get("OVERRIDE_LAUNCH_LOG_FORMAT") or log_format
        self._log_formatter = make_formatter(text, log_style, LOG_FORMATS)
        for handler in self._handlers.values():
            handler.setFormatter(self._log_formatter)

    @property
    def screen_formatter(self) -> LaunchFormatter:
        return self._screen_formatter

    def get_screen_handler(self) -> ScreenHandler:
        """Return the handler that writes to the terminal."""
        if self._screen_handler is None:
            self._screen_handler = ScreenHandler()
            self._screen_handler.setFormatter(self._screen_formatter)
        return self._screen_handler

    def get_log_file_path(self, file_name: str = LOG_FILE) -> str:
        """Return the path of a log file in the folder of the logs."""
        return str(Path(self.log_dir) / file_name)

    def get_log_file_handler(self, file_name: str = LOG_FILE) -> Any:
        """Return the handler that writes to a log file."""
        if file_name not in self._handlers:
            path = self.get_log_file_path(file_name)
            Path(path).parent.mkdir(parents=True, exist_ok=True)
            handler = self.log_handler_factory(path, encoding="utf-8")
            handler.setFormatter(self._log_formatter)
            self._handlers[file_name] = handler
        return self._handlers[file_name]


launch_config = LaunchConfig()
