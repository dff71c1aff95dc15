"""Interface of a recording that is played, as the live view needs it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol


class PlaybackStatus(IntEnum):
    """Values as in the Foxglove protocol."""

    PLAYING = 0
    PAUSED = 1
    BUFFERING = 2
    ENDED = 3


@dataclass(frozen=True)
class PlaybackState:
    """Status, position (recording time) and speed factor."""

    status: PlaybackStatus
    position_ns: int
    speed: float


class DisplayClock(Protocol):
    """The time that clients display: of the recording that is played, else now."""

    @property
    def now_ns(self) -> int:
        """Nanoseconds; callable from any thread."""


class Playback(Protocol):
    """A recording that is played; only :meth:`state` is callable from any thread."""

    @property
    def begin_ns(self) -> int:
        """First stamp to seek to."""

    @property
    def end_ns(self) -> int:
        """Last stamp to seek to."""

    def state(self) -> PlaybackState: ...

    def control(self, *, play: bool, speed: float, seek_ns: int | None) -> None:
        """Seek, set the speed, then play or pause.

        Raises:
            InvalidValueError: the speed is not a positive number.
        """

    def step(self) -> None:
        """Pause, and publish the next message."""

    def on_change(self, callback: Callable[[bool], None]) -> None:
        """Call ``callback`` after every change; its argument is true after a seek."""
