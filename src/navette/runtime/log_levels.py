"""Severities of log messages."""

from enum import IntEnum

from navette.errors import InvalidValueError


class LoggingSeverity(IntEnum):
    """Severities with the numbers of rcutils and rcl_interfaces/msg/Log."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


def severity_from_string(text: str) -> LoggingSeverity:
    """Return the severity of a name such as ``info``, in upper or lower case.

    Raises:
        InvalidValueError: the name is unknown; lists the known ones.
    """
    name = text.upper()
    name = "WARN" if name == "WARNING" else name
    if name not in LoggingSeverity.__members__:
        known = ", ".join(m.lower() for m in LoggingSeverity.__members__)
        raise InvalidValueError(f"log level {text!r}; known: {known}")
    return LoggingSeverity[name]
