"""Virtual time that advances step by step, in all processes of a lock-step together.

A step is a piece of virtual time, ``(T, T + step]``. Each process runs its own events
in it. Samples to other processes are buffered there until the next step begins, and are
then delivered in an order that is the same in every run. The result therefore does not
depend on the speed of the processes or of the network.
"""

import logging
from abc import abstractmethod
from collections.abc import Callable

from navette.errors import LockStepError
from navette.runtime.clock import ContextClock, Stopwatch
from navette.runtime.wakeup import Wakeup
from navette.transports.lockstep import (
    Participants,
    StepGrant,
    StepReport,
    StepTraffic,
    StepWire,
)

LIMIT_S = 30.0
"""Wall time that a process may take for a step before the run ends."""

REPEAT_S = 1.0
"""Wall time after which a report or grant is sent again: the link may have changed."""

LOG_AFTER_S = 5.0
"""Wall time after which the reason for waiting is logged; again when it changes."""

_log = logging.getLogger(__name__)


class LockStepClock(ContextClock):
    """Advances to the end of the granted step, then waits for the next grant.

    Args:
        limit_s: wall time that other processes may take for a step.
    """

    is_virtual = True
    jumps = True
    is_shared = True
    now_ns: int = 0

    def __init__(self, limit_s: float = LIMIT_S) -> None:
        self.traffic = StepTraffic()
        self.traffic.buffer.on_complete = self._wake
        self.limit_s = limit_s
        #: Called at the regular end of the run.
        self.on_end: Callable[[], object] = lambda: None
        #: Number of the granted step.
        self.step = 0
        self._granted_ns = 0
        self._wire: StepWire | None = None
        self._wakeup: Wakeup | None = None
        self._next: StepGrant | None = None  # granted, waits for samples
        self._is_over = False
        self._waiting = Stopwatch()
        self.log_after_s = LOG_AFTER_S
        self._since_log = Stopwatch()
        self._logged = ""

    @property
    def wire(self) -> StepWire:
        """The connection to the other processes.

        Raises:
            LockStepError: the context has not joined the network.
        """
        if self._wire is None:
            raise LockStepError("lock-step: the context is not on the network")
        return self._wire

    @abstractmethod
    def join(self, wire: StepWire) -> None:
        """Take part in the lock-step; called before the first node is announced."""

    def go_to(self, target_ns: int | None, wakeup: Wakeup) -> bool:
        """As in the base class; at the end of a step, wait for the other processes.

        Raises:
            LockStepError: a process is gone or does not respond.
        """
        self._wakeup = wakeup
        if target_ns is not None and target_ns <= self._granted_ns:
            self.now_ns = max(self.now_ns, target_ns)
            return True
        self.now_ns = self._granted_ns
        if self._next is not None and self.traffic.buffer.is_complete():
            self._begin(self._next)
        else:
            self._wait_for_step(self.wire.participants(), wakeup)
        return False

    def _wait_for_step(self, participants: Participants, wakeup: Wakeup) -> None:
        if wakeup.is_pending:  # events that came with the participants are run first
            return
        if not (self._is_over or (self._next is not None and self._next.is_last)):
            self._check_present(participants)
        if self._next is None:
            self._wait_for_others(participants, wakeup)
        else:
            self._wait_for_samples(wakeup)

    @abstractmethod
    def _check_present(self, participants: Participants) -> None:
        """Raise LockStepError if a required process is gone."""

    @abstractmethod
    def _wait_for_others(self, participants: Participants, wakeup: Wakeup) -> None:
        """Wait for reports or a grant: this process has no events left in the step."""

    def _accept(self, grant: StepGrant) -> None:
        """Begin the granted step when all samples of the previous one have arrived."""
        self._waiting = Stopwatch()
        if self.traffic.buffer.expect(grant.sent):
            self._begin(grant)
        else:
            self._next = grant

    def _wait_for_samples(self, wakeup: Wakeup) -> None:
        if not wakeup.wait(self._remaining_s):
            missing = ", ".join(
                f"{m.samples} of {m.topic} by {m.node}"
                for m in self.traffic.buffer.missing()[:10]
            )
            raise LockStepError(
                f"lock-step: messages did not arrive within {self.limit_s:g} s at "
                f"{self.now_ns / 1e9:g} s: {missing}"
            )

    def _begin(self, grant: StepGrant) -> None:
        self._next = None
        self.step = grant.step
        self._granted_ns = grant.until_ns
        self._is_over = grant.is_last
        self.traffic.sent_counter.granted(grant.sent)
        self._waiting = Stopwatch()
        self.traffic.buffer.release(self.now_ns)

    def _own_report(self, participants: Participants) -> StepReport:
        return StepReport(
            self.step,
            participants.nodes,
            participants.own,
            participants.seen,
            self.traffic.sent_counter.changed(),
        )

    @property
    def _remaining_s(self) -> float:
        """What is left of the limit."""
        return max(0.0, self.limit_s - self._waiting.elapsed_s)

    def _wake(self) -> None:
        if self._wakeup is not None:
            self._wakeup.set()

    def _log_waiting(self, text: str) -> None:
        """Log once what this process waits for, after it has waited for a while."""
        if text != self._logged and self._since_log.elapsed_s >= self.log_after_s:
            self._logged, self._since_log = text, Stopwatch()
            _log.warning("lock-step: %s", text)
