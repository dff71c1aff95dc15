"""What the live view needs to know of a recording that is played, and may ask of it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol


class PlaybackStatus(IntEnum):
    """Values as on the socket."""

    PLAYING = 0
    PAUSED = 1
    BUFFERING = 2
    ENDED = 3


@dataclass(frozen=True)
class PlaybackState:
    """Where a recording is; ``position_ns`` in its own time."""

    status: PlaybackStatus
    position_ns: int
    speed: float


class Playback(Protocol):
    """A recording that is played; only :meth:`state` may be asked from any thread."""

    @property
    def begin_ns(self) -> int:
        """First stamp that can be gone to."""

    @property
    def end_ns(self) -> int:
        """Last stamp that can be gone to."""

    def state(self) -> PlaybackState:
        """How it is now."""

    def control(self, *, play: bool, speed: float, seek_ns: int | None) -> None:
        """Go to a place, at a speed, and play or pause there.

        Raises:
            InvalidValueError: no speed.
        """

    def step(self) -> None:
        """Pause, and say the next message."""

    def on_change(self, callback: Callable[[bool], None]) -> None:
        """Call back after every change, with whether it was a jump."""
