"""Status message with methods to fill it."""

# ruff: noqa: N802 - the names are diagnostic_updater's

from typing import Any

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus, KeyValue


class DiagnosticStatusWrapper(DiagnosticStatus):
    """A DiagnosticStatus with methods to set its summary and values."""

    def summary(self, *args: Any) -> None:
        """Set level and message: ``summary(level, message)`` or ``summary(status)``."""
        self.level, self.message = _summary_of(args)

    def clearSummary(self) -> None:
        self.summary(DiagnosticStatus.OK, "")

    def mergeSummary(self, *args: Any) -> None:
        """Merge another summary; arguments as for :meth:`summary`.

        The worse level counts. If both summaries are OK, or neither is, the messages
        are joined; otherwise the message of the summary that is not OK remains.
        """
        level, message = _summary_of(args)
        is_bad, was_bad = level > DiagnosticStatus.OK, self.level > DiagnosticStatus.OK
        if is_bad == was_bad:
            self.message = f"{self.message}; {message}" if self.message else message
        elif is_bad:
            self.message = message
        self.level = max(self.level, level)

    def add(self, key: str, val: object) -> None:
        self.values.append(KeyValue(key=key, value=str(val)))


def _summary_of(args: tuple[Any, ...]) -> tuple[bytes, str]:
    if len(args) == 1:
        return args[0].level, args[0].message
    if len(args) == 2:
        return args[0], str(args[1])
    raise TypeError(
        f"expected a status, or a level and a message; got {len(args)} arguments"
    )
