"""Options of playback."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from navette.errors import InvalidValueError, UnknownNameError, join_names

MIN_RATE = 0.001
MAX_RATE = 10_000.0
# The time to declare n publishers on a Zenoh session grows with n²: 4 s for 4,000.
MAX_TOPICS = 4000


@dataclass(frozen=True, kw_only=True)
class PlayOptions:
    """The part of a bag to play, and the rate.

    ``regex`` and ``exclude`` are searched anywhere in a topic's name. With neither
    ``topics`` nor ``regex`` every topic is played.
    """

    rate: float = 1.0
    loop: bool = False
    paused: bool = False
    start_offset_s: float = 0.0
    duration_s: float | None = None
    topics: tuple[str, ...] = ()
    regex: str = ""
    exclude: str = ""

    def __post_init__(self) -> None:
        check_rate(self.rate)
        if not (math.isfinite(self.start_offset_s) and self.start_offset_s >= 0):
            raise InvalidValueError(
                f"start offset {self.start_offset_s!r}: expected 0 seconds or more"
            )
        if self.duration_s is not None and not 0 < self.duration_s < math.inf:
            raise InvalidValueError(
                f"duration {self.duration_s!r}: must be more than 0 seconds, finite"
            )
        for name in ("regex", "exclude"):
            try:
                re.compile(getattr(self, name))
            except re.error as error:
                raise InvalidValueError(
                    f"{name} {getattr(self, name)!r} is not a regular "
                    f"expression: {error}"
                ) from None

    def choose(self, names: Iterable[str]) -> tuple[str, ...]:
        """Select the topics to play.

        Raises:
            UnknownNameError: a named topic was not recorded.
            InvalidValueError: no topic is selected, or too many.
        """
        known = list(dict.fromkeys(names))
        by_full_name = {_full(name): name for name in known}
        for name in self.topics:
            if _full(name) not in by_full_name:
                raise UnknownNameError.of("topic", name, known)
        wanted = [by_full_name[_full(name)] for name in self.topics]
        chosen = tuple(n for n in known if self._takes(n, wanted))
        if not chosen:
            raise InvalidValueError(
                "no topic is selected; recorded topics: "
                f"{join_names(known, most=100) or 'none'}"
            )
        if len(chosen) > MAX_TOPICS:
            raise InvalidValueError(
                f"{len(chosen)} topics; at most {MAX_TOPICS} are played: "
                "choose some by name or regular expression"
            )
        return chosen

    def _takes(self, name: str, wanted: list[str]) -> bool:
        if self.exclude and re.search(self.exclude, name):
            return False
        if not wanted and not self.regex:
            return True
        matches = bool(self.regex) and re.search(self.regex, name) is not None
        return name in wanted or matches


def _full(name: str) -> str:
    return f"/{name.lstrip('/')}"


def check_rate(rate: float) -> float:
    """Return the rate if it is valid.

    Raises:
        InvalidValueError: out of range.
    """
    if not MIN_RATE <= rate <= MAX_RATE:
        raise InvalidValueError(
            f"rate {rate!r}: expected {MIN_RATE:g} to {MAX_RATE:g} times real time"
        )
    return float(rate)
