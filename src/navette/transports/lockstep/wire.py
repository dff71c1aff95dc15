"""What a lock-step needs of the network."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from navette.transports.lockstep.held import HeldSamples
from navette.transports.lockstep.records import Grant, Report
from navette.transports.lockstep.tally import SentTally


class StepTraffic:
    """A process's samples in lock-step: those that came, and those that went."""

    def __init__(self) -> None:
        self.held = HeldSamples()
        self.tally = SentTally()


@dataclass(frozen=True)
class Census:
    """Who is there, as a process sees it.

    Attributes:
        nodes: full names of the nodes here.
        others: full names of the nodes elsewhere.
        own: how many nodes and endpoints are announced here.
        seen: session → how many of it are known here.
    """

    nodes: tuple[str, ...]
    others: tuple[str, ...]
    own: int
    seen: Mapping[str, int]


class StepWire(ABC):
    """Carries reports to the conductor and its grants to all; nothing is lost."""

    @property
    @abstractmethod
    def session(self) -> str:
        """By which the others know this process."""

    @abstractmethod
    def census(self) -> Census:
        """Who is there; everybody here has been told of it."""

    @abstractmethod
    def report(self, report: Report) -> None:
        """Tell the conductor."""

    @abstractmethod
    def grant(self, grant: Grant) -> None:
        """Tell all the others."""

    @abstractmethod
    def hear_reports(self, callback: Callable[[str, Report], None]) -> None:
        """Call back with session and report, in another thread."""

    @abstractmethod
    def hear_grants(self, callback: Callable[[Grant], None]) -> None:
        """Call back with every grant, in another thread."""
