"""A status message that is easy to fill in."""

# ruff: noqa: N802 - the names are diagnostic_updater's

from typing import Any

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue


class DiagnosticStatusWrapper(DiagnosticStatus):
    """A DiagnosticStatus; fields as keywords."""

    def summary(self, *args: Any) -> None:
        """Set level and message: ``summary(level, message)`` or those of a status."""
        self.level, self.message = _summary_of(args)

    def clearSummary(self) -> None:
        """Level OK, no message."""
        self.summary(DiagnosticStatus.OK, "")

    def mergeSummary(self, *args: Any) -> None:
        """Take in a further summary, given as to :meth:`summary`.

        The worse level counts. Messages of two that are both fine, or both not, are
        put one behind the other; else the message of the one that is not fine stays.
        """
        level, message = _summary_of(args)
        is_bad, was_bad = level > DiagnosticStatus.OK, self.level > DiagnosticStatus.OK
        if is_bad == was_bad:
            self.message = f"{self.message}; {message}" if self.message else message
        elif is_bad:
            self.message = message
        self.level = max(self.level, level)

    def add(self, key: str, val: object) -> None:
        """Add a value under a name; anything that can be written as text."""
        self.values.append(KeyValue(key=key, value=str(val)))


def _summary_of(args: tuple[Any, ...]) -> tuple[bytes, str]:
    if len(args) == 1:
        return args[0].level, args[0].message
    if len(args) == 2:
        return args[0], str(args[1])
    raise TypeError(
        f"wanted a status, or a level and a message; got {len(args)} arguments"
    )
