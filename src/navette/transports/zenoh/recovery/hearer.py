"""Who may miss something, and what it misses."""

from typing import Protocol

from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery.answer import Parts, Recovered


class Hearer(Protocol):
    """A reliable subscription."""

    matches: Matches
    key: str

    def start_after(self, gid: bytes, number: int) -> None:
        """What comes after that number is owed to it; any thread."""

    def start(self, gid: bytes) -> None:
        """Nobody will say from where on; any thread."""

    def is_held_up(self, gid: bytes) -> bool:
        """Whether something waits to be told from where on it is owed something."""

    def reach(self, gid: bytes, number: int) -> None:
        """The publisher has come to that number; any thread."""

    def missing(self, gid: bytes) -> tuple[int, int] | None:
        """First and last number of the first gap."""

    def recover(self, gid: bytes, sample: Recovered) -> None:
        """A sample that was asked for."""

    def give_up(self, gid: bytes, number: int | None) -> None:
        """What is missing up to that number (None: all) is lost."""


class Want:
    """Something is missing of a publisher at a subscription."""

    __slots__ = (
        "gid",
        "hearer",
        "is_parked",
        "parts",
        "takes_long",
        "ticks",
        "tries",
    )

    def __init__(self, hearer: Hearer, gid: bytes, parts: Parts) -> None:
        self.hearer = hearer
        self.gid = gid
        self.parts = parts
        self.tries = 0
        self.ticks = 0
        self.takes_long = False
        self.is_parked = False
