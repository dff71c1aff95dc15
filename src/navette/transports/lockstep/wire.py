"""Interface between a lock-step and the network."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from navette.transports.lockstep.records import StepGrant, StepReport
from navette.transports.lockstep.sample_buffer import SampleBuffer
from navette.transports.lockstep.sent_counter import SentCounter


class StepTraffic:
    """A process's samples in lock-step: those received and those sent."""

    def __init__(self) -> None:
        self.buffer = SampleBuffer()
        self.sent_counter = SentCounter()


@dataclass(frozen=True)
class Participants:
    """Nodes and endpoints on the network, as one process sees them.

    Attributes:
        nodes: full names of this process's nodes.
        others: full names of the nodes of other processes.
        own: how many nodes and endpoints this process has announced.
        seen: session → how many nodes and endpoints of it are known here.
    """

    nodes: tuple[str, ...]
    others: tuple[str, ...]
    own: int
    seen: Mapping[str, int]


class StepWire(ABC):
    """Carries reports to the coordinator and its grants to the participants."""

    @property
    @abstractmethod
    def session(self) -> str:
        """Id of this process on the network."""

    @abstractmethod
    def participants(self) -> Participants:
        """Return who is on the network; all observers here have been notified."""

    @abstractmethod
    def send_report(self, report: StepReport) -> None:
        """Send a report to the coordinator."""

    @abstractmethod
    def send_grant(self, grant: StepGrant) -> None:
        """Send a grant to all participants."""

    @abstractmethod
    def subscribe_reports(self, callback: Callable[[str, StepReport], None]) -> None:
        """Call back with session and report, in another thread."""

    @abstractmethod
    def subscribe_grants(self, callback: Callable[[StepGrant], None]) -> None:
        """Call back with every grant, in another thread."""
