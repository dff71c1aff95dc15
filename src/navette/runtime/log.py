"""Loggers with ROS 2's levels and filters; the hub passes records to sinks."""

import logging
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

from navette.errors import InvalidValueError
from navette.runtime.log_levels import LoggingSeverity


@dataclass(frozen=True, slots=True)
class LogRecord:
    """One log message for the console, the file and ``/rosout``."""

    stamp_ns: int
    severity: LoggingSeverity
    name: str
    message: str
    function: str = ""
    file: str = ""
    line: int = 0


LogSink = Callable[[LogRecord], None]
"""Receiver of log records; the hub calls the sinks in order."""


class LogOrigin(Protocol):
    """Where records come from: the loop that runs the nodes."""

    @property
    def now_ns(self) -> int:
        """The stamp of a record."""

    @property
    def running_node(self) -> str:
        """Full name of the node whose callback runs, or ""."""


class LogHub:
    """Log levels and sinks of one context."""

    def __init__(self, origin: LogOrigin) -> None:
        self.origin = origin
        self.sinks: list[LogSink] = []
        #: Receives the records while there is no sink, if set.
        self.fallback: LogSink | None = None
        self.default_level = LoggingSeverity.INFO
        self._levels: dict[str, LoggingSeverity] = {}
        self._effective: dict[str, LoggingSeverity] = {}

    def set_level(self, name: str, level: int) -> None:
        """Set the level of a logger and its children.

        The name "" stands for all loggers; UNSET restores inheritance.
        """
        level = LoggingSeverity(level)
        if name:
            self._levels[name] = level
        else:
            self.default_level = level or LoggingSeverity.INFO
        self._effective.clear()

    def reset_levels(self) -> None:
        self.default_level = LoggingSeverity.INFO
        self._levels.clear()
        self._effective.clear()

    def get_level(self, name: str) -> LoggingSeverity:
        """Return the level of this logger itself, UNSET if it inherits."""
        if not name:
            return self.default_level
        return self._levels.get(name, LoggingSeverity.UNSET)

    def effective_level(self, name: str) -> LoggingSeverity:
        """Return the logger's own level or that of its nearest parent with one."""
        level = self._effective.get(name)
        if level is None:
            level = self._effective[name] = self._find_level(name)
        return level

    def emit(self, record: LogRecord) -> None:
        for sink in self.sinks:
            sink(record)
        if not self.sinks and self.fallback is not None:
            self.fallback(record)

    def _find_level(self, name: str) -> LoggingSeverity:
        while name:
            level = self._levels.get(name, LoggingSeverity.UNSET)
            if level:
                return level
            name = name.rpartition(".")[0]
        return self.default_level


_FILTERS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")


class _CallSite:
    """Filter state of one logging statement."""

    __slots__ = ("last_ns", "logged", "severity", "skipped")

    def __init__(self, severity: LoggingSeverity) -> None:
        self.severity = severity
        self.last_ns: int | None = None
        self.logged = False
        self.skipped = False

    def lets_through(self, now_ns: int, filters: dict[str, Any]) -> bool:
        """Apply the filters in rclpy's order (throttle, skip_first, once)."""
        throttle_s = filters.get("throttle_duration_sec")
        if throttle_s:
            if self.last_ns is not None and now_ns < self.last_ns + throttle_s * 1e9:
                return False
            self.last_ns = now_ns
        if filters.get("skip_first") and not self.skipped:
            self.skipped = True
            return False
        if filters.get("once"):
            if self.logged:
                return False
            self.logged = True
        return True


class Logger:
    """A named logger; its children (``node.child``) inherit its level."""

    def __init__(self, name: str, hub: LogHub) -> None:
        self.name = name
        self._hub = hub
        self._sites: dict[tuple[str, int, int], _CallSite] = {}

    def get_child(self, name: str) -> "Logger":
        if not name:
            raise InvalidValueError("child logger name must not be empty")
        return Logger(f"{self.name}.{name}" if self.name else name, self._hub)

    def set_level(self, level: int) -> None:
        self._hub.set_level(self.name, level)

    def get_effective_level(self) -> LoggingSeverity:
        return self._hub.effective_level(self.name)

    def is_enabled_for(self, severity: int) -> bool:
        return severity >= self._hub.effective_level(self.name)

    def log(self, message: object, severity: int, **filters: Any) -> bool:
        """Log a message; return False if the level or a filter suppresses it.

        Keyword Args:
            once: log only the first time that this line is reached.
            skip_first: do not log the first time.
            throttle_duration_sec: shortest time between two messages, in s.
            throttle_time_source_type: the clock for the throttle.
            name: name of another logger.
        """
        return self._log(message, LoggingSeverity(severity), filters)

    def debug(self, message: object, **filters: Any) -> bool:
        return self._log(message, LoggingSeverity.DEBUG, filters)

    def info(self, message: object, **filters: Any) -> bool:
        return self._log(message, LoggingSeverity.INFO, filters)

    def warning(self, message: object, **filters: Any) -> bool:
        return self._log(message, LoggingSeverity.WARN, filters)

    def warn(self, message: object, **filters: Any) -> bool:
        return self._log(message, LoggingSeverity.WARN, filters)

    def error(self, message: object, **filters: Any) -> bool:
        return self._log(message, LoggingSeverity.ERROR, filters)

    def fatal(self, message: object, **filters: Any) -> bool:
        return self._log(message, LoggingSeverity.FATAL, filters)

    def _log(
        self, message: object, severity: LoggingSeverity, filters: dict[str, Any]
    ) -> bool:
        name = filters.pop("name", None) or self.name
        if severity < self._hub.effective_level(name):
            return False
        frame = sys._getframe(2)  # the statement that called info(), warn(), …
        code = frame.f_code
        if filters:
            _check_filters(filters)
            key = (code.co_filename, frame.f_lineno, frame.f_lasti)
            site = self._sites.setdefault(key, _CallSite(severity))
            if site.severity != severity:
                raise ValueError("severity of a filtered log line cannot change")
            clock = filters.get("throttle_time_source_type")
            now_ns = clock.now().nanoseconds if clock else self._hub.origin.now_ns
            if not site.lets_through(now_ns, filters):
                return False
        self._hub.emit(
            LogRecord(
                self._hub.origin.now_ns,
                severity,
                name,
                str(message),
                code.co_name,
                code.co_filename,
                frame.f_lineno,
            )
        )
        return True


def _check_filters(filters: dict[str, Any]) -> None:
    for name in filters:
        if name not in _FILTERS:
            raise TypeError(
                f"unknown logging option {name!r}; known: {', '.join(_FILTERS)}"
            )


class StdlibHandler(logging.Handler):
    """Handler that passes records of ``logging.getLogger`` (algorithms) to a hub.

    A record belongs to the node whose callback runs (``/rosout``, level).
    """

    def __init__(self, hub: LogHub) -> None:
        super().__init__()
        self._hub = hub

    def emit(self, record: logging.LogRecord) -> None:
        severity = LoggingSeverity(
            min(max(record.levelno // 10 * 10, LoggingSeverity.DEBUG), 50)
        )
        name = record.name
        node = self._hub.origin.running_node.strip("/").replace("/", ".")
        if node:
            name = f"{node}.{name.rpartition('.')[2]}"
        if severity < self._hub.effective_level(name):
            return
        self._hub.emit(
            LogRecord(
                self._hub.origin.now_ns,
                severity,
                name,
                record.getMessage(),
                record.funcName or "",
                record.pathname,
                record.lineno,
            )
        )
