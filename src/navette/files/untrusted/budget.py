"""Budget of an untrusted input: size, number of parts, nesting.

One set of limits for bags, YAML, XML and the frames of viewers. Work is counted instead
of timed, so that an input is accepted or refused independently of the machine: every
reader is linear in what it counts here, which bounds its time as well.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from navette.errors import NavetteError


class BudgetError(NavetteError, ValueError):
    """An input exceeds a limit; names the limit."""


@dataclass(frozen=True, kw_only=True)
class Budget:
    """Limits of one input."""

    octets: int
    """Bytes, after decompression."""
    items: int
    """Parts that it consists of: nodes, elements, records, list items."""
    depth: int = 64
    """Nesting."""
    word: int = 1000
    """Characters of a number or a name."""

    def check_octets(self, count: int, what: str = "input") -> None:
        """Refuse an input by its size, before it is read.

        Raises:
            BudgetError: too large.
        """
        if count > self.octets:
            raise BudgetError(
                f"{what} of {count} bytes; at most {self.octets} are allowed"
            )

    def check_items(self, count: int, what: str = "items") -> None:
        """Refuse a list by its length.

        Raises:
            BudgetError: too long.
        """
        if count > self.items:
            raise BudgetError(f"{count} {what}; at most {self.items} are allowed")

    def check_word(self, count: int, what: str = "name") -> None:
        """Refuse a string by its length.

        Raises:
            BudgetError: too long.
        """
        if count > self.word:
            raise BudgetError(
                f"{what} of {count} characters; at most {self.word} are allowed"
            )


class BudgetMeter:
    """Counts what one input has used of its budget."""

    def __init__(self, budget: Budget) -> None:
        self.budget = budget
        self.octets = 0
        self.items = 0
        self.depth = 0

    def spend_octets(self, count: int, what: str = "input") -> None:
        self.octets += count
        self.budget.check_octets(self.octets, what)

    def spend_items(self, count: int = 1, what: str = "items") -> None:
        self.items += count
        if self.items > self.budget.items:
            raise BudgetError(f"more than {self.budget.items} {what}")

    @contextmanager
    def nested(self) -> Iterator[None]:
        """Count one level of nesting."""
        self.enter()
        yield
        self.leave()

    def enter(self) -> None:
        self.depth += 1
        if self.depth > self.budget.depth:
            raise BudgetError(f"nested deeper than {self.budget.depth}")

    def leave(self) -> None:
        self.depth -= 1


DOCUMENT = Budget(octets=4 << 20, items=100_000)
"""YAML and XML files that people write: parameters, launch files, manifests."""

SCENE = Budget(octets=32 << 20, items=4_000_000)
"""Worlds and robot models."""

QOS = Budget(octets=1 << 16, items=20_000, depth=8)
"""QoS profiles of one recorded topic."""

METADATA = Budget(octets=16 << 20, items=500_000, depth=32)
"""``metadata.yaml`` of a recording."""

FRAME = Budget(octets=64 << 10, items=1000, depth=32)
"""Request of a client of the live view; parsing takes a millisecond at most."""

CLIENT_MESSAGE = Budget(octets=256 << 10, items=100_000, depth=32)
"""Message that a client of the live view publishes, except for plain arrays in CDR."""
