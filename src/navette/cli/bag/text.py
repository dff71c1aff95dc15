"""Format sizes, times, rates and counts of recordings."""

from datetime import UTC, datetime

from navette.cli.output import is_terminal

_UNITS = ("B", "kB", "MB", "GB", "TB")
_EPOCH_FROM_S = 10**8
"""Smaller stamps are seconds since the start of a robot, not a date."""


def size_text(size: int) -> str:
    """Return ``3.7 MB``, in powers of 1000."""
    value, unit = float(size), 0
    while value >= 999.95 and unit < len(_UNITS) - 1:
        value, unit = value / 1000, unit + 1
    return f"{value:.1f} {_UNITS[unit]}" if unit else f"{size} B"


def duration_text(seconds: float) -> str:
    """Return ``12:20 (740.55 s)``; below a minute only seconds."""
    plain = f"{seconds:.2f} s"
    if seconds < 60:
        return plain
    hours, rest = divmod(int(seconds), 3600)
    minutes, whole = divmod(rest, 60)
    clock = f"{hours}:{minutes:02}:{whole:02}" if hours else f"{minutes}:{whole:02}"
    return f"{clock} ({plain})"


def stamp_text(stamp_ns: int) -> str:
    """Return a date with the seconds since 1970, or only seconds for a robot's time."""
    milliseconds = round(stamp_ns / 1e6)
    seconds = milliseconds / 1e3
    if abs(seconds) < _EPOCH_FROM_S:
        return f"{seconds:.3f} s"
    whole, rest = divmod(milliseconds, 1000)
    try:
        date = datetime.fromtimestamp(whole, UTC).strftime("%Y-%m-%d %H:%M:%S")
    except (ValueError, OverflowError, OSError):
        return f"{seconds:.3f}"
    return f"{date}.{rest:03} UTC ({seconds:.3f})"


def gap_text(seconds: float | None) -> str:
    """Return the time between two messages."""
    if seconds is None:
        return ""
    if seconds < 1:
        return f"{seconds * 1e3:.3g} ms"
    return f"{seconds:.3g} s" if seconds < 1000 else f"{seconds:.0f} s"


def rate_text(rate_hz: float | None) -> str:
    """Return ``10.0 Hz``; slow rates as a period."""
    if rate_hz is None:
        return ""
    if rate_hz < 0.1:
        return f"every {1 / rate_hz:.3g} s"
    return f"{rate_hz:.3g} Hz" if rate_hz < 100 else f"{rate_hz:.0f} Hz"


def count_text(count: int, *, grouped: bool | None = None) -> str:
    """Return ``12 765``, in groups of three digits on a terminal."""
    if grouped is None:
        grouped = is_terminal()
    return f"{count:,}".replace(",", "\u202f") if grouped else str(count)


def counted(count: int, noun: str) -> str:
    """Return ``1 message`` or ``2 messages``."""
    return f"{count_text(count)} {noun}{'s' * (count != 1)}"
