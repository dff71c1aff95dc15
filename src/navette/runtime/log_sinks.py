"""Sinks of log records: console and file. Each node publishes ``/rosout`` itself."""

import os
import sys
import time
from pathlib import Path
from typing import TextIO

from navette.errors import FileFormatError
from navette.files.terminal_lines import filled
from navette.files.untrusted.escaping import escaped_but_coloured
from navette.runtime.log import LogRecord
from navette.runtime.log_levels import LoggingSeverity

_COLOURS = {
    LoggingSeverity.DEBUG: "\x1b[32m",
    LoggingSeverity.WARN: "\x1b[33m",
    LoggingSeverity.ERROR: "\x1b[31m",
    LoggingSeverity.FATAL: "\x1b[31m",
}
_RESET = "\x1b[0m"


def format_record(record: LogRecord) -> str:
    """Return ``[INFO] [1.500000000] [name]: message``, ROS 2's format."""
    seconds, nanoseconds = divmod(record.stamp_ns, 1_000_000_000)
    return (
        f"[{record.severity.name}] [{seconds}.{nanoseconds:09d}] "
        f"[{record.name}]: {record.message}"
    )


class ConsoleSink:
    """Sink that writes to standard error, on a terminal with colours and wrapped lines.

    In a pipe each record is one line, except for newlines of its message.

    Args:
        stream: replaces standard error.
        least: records below this severity are not written.
    """

    def __init__(
        self,
        stream: TextIO | None = None,
        *,
        least: LoggingSeverity = LoggingSeverity.DEBUG,
    ) -> None:
        self._stream = stream
        self._least = least

    def __call__(self, record: LogRecord) -> None:
        if record.severity < self._least:
            return
        # sys.stderr is read here because programs and tests replace it.
        stream = self._stream or sys.stderr
        text = escaped_but_coloured(format_record(record))
        if stream.isatty():
            columns = _columns(stream)
            text = "\n".join(filled(line, columns) for line in text.split("\n"))
            colour = _COLOURS.get(record.severity, "")
            text = f"{colour}{text}{_RESET}" if colour else text
        stream.write(text + "\n")
        stream.flush()


def _columns(stream: TextIO) -> int:
    """Return the terminal's width.

    Unlimited for a pseudo-terminal without a size: a program reads its lines, as
    launch does with ``emulate_tty``.
    """
    try:
        return os.get_terminal_size(stream.fileno()).columns or sys.maxsize
    except OSError:
        return sys.maxsize


class FileSink:
    """Sink that appends one line per record to a file.

    Raises:
        FileFormatError: the file cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("a", encoding="utf-8")
        except OSError as error:
            raise FileFormatError(path, f"cannot be written: {error}") from error

    def __call__(self, record: LogRecord) -> None:
        self._file.write(format_record(record) + "\n")
        self._file.flush()

    def close(self) -> None:
        self._file.close()


def get_logging_directory() -> Path:
    """Return ROS 2's log directory: ROS_LOG_DIR, ROS_HOME/log or ~/.ros/log."""
    directory = os.environ.get("ROS_LOG_DIR")
    if directory:
        return Path(directory).expanduser()
    home = os.environ.get("ROS_HOME") or "~/.ros"
    return Path(home).expanduser() / "log"


def new_log_file(name: str) -> Path:
    """Return the path of a new log file, named as ROS 2 does."""
    # The name only, and of any clock: nodes may run in simulated time.
    stamp_ms = time.time_ns() // 1_000_000  # noqa: TID251 - see above
    return get_logging_directory() / f"{name}_{os.getpid()}_{stamp_ms}.log"
