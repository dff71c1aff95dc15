"""Formats of log records, by name or as a format string."""

import logging
from typing import Literal, cast

ROOT = "navette.launch"
STYLES = ("%", "{", "$")
Style = Literal["%", "{", "$"]
#: Name → format string in style ``{``.
SCREEN_FORMATS = {
    "default": "[{levelname}] [{name}]: {msg}",
    "default_with_timestamp": "{created:.7f} [{levelname}] [{name}]: {msg}",
}
LOG_FORMATS = {"default": "{created:.7f} [{levelname}] [{name}]: {msg}"}


class LaunchFormatter(logging.Formatter):
    """Formatter in which ``name`` lacks the prefix of launches and ``msg`` is final."""

    def format(self, record: logging.LogRecord) -> str:
        shown = logging.makeLogRecord(vars(record))
        shown.name = record.name.removeprefix(f"{ROOT}.")
        shown.msg, shown.args = record.getMessage(), ()
        return super().format(shown)


def make_formatter(
    text: str, style: str | None, known: dict[str, str]
) -> LaunchFormatter:
    """Return the formatter of a named format or of a format string.

    Raises:
        ValueError: unknown style, or a style beside the name of a format.
    """
    if style is not None and style not in STYLES:
        raise ValueError(f"style {style!r}; expected one of {', '.join(STYLES)}")
    if text in known:
        if style not in (None, "{"):
            raise ValueError(
                f"style {style!r} of format {text!r}: its style is '{{'; leave it out"
            )
        text, style = known[text], "{"
    return LaunchFormatter(text, style=cast("Style", style or "{"), validate=False)
