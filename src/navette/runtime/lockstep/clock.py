"""Time that goes on step by step, in all processes of a lock-step at once.

A step is a piece of virtual time, ``(T, T + step]``. Each process runs its own events
in it; what they send to other processes is held there until the next step begins, and
then comes in at its beginning, in an order that is the same in every run. So nobody
can tell who was faster: not the processes, not the network.
"""

import logging
from abc import abstractmethod
from collections.abc import Callable

from navette.errors import LockStepError
from navette.runtime.clock import ContextClock, Stopwatch, Wakeup
from navette.transports.lockstep import Census, Grant, Report, StepTraffic, StepWire

LIMIT_S = 30.0
"""Wall time that a process may take for a step before the run ends."""

AGAIN_S = 1.0
"""Wall time after which what was said is said again: a link may just have changed."""

SAY_AFTER_S = 5.0
"""Wall time after which it is told what is waited for; and again when that changes."""

_log = logging.getLogger(__name__)


class LockStepClock(ContextClock):
    """Goes as far as was granted, then says so and waits for more.

    Args:
        limit_s: wall time that others may take.
    """

    is_virtual = True
    is_shared = True
    now_ns: int = 0

    def __init__(self, limit_s: float = LIMIT_S) -> None:
        self.traffic = StepTraffic()
        self.traffic.held.on_complete = self._wake
        self.limit_s = limit_s
        #: What to do when the run is over, as was wanted.
        self.on_end: Callable[[], object] = _nothing
        #: How many steps were granted so far.
        self.step = 0
        self._granted_ns = 0
        self._wire: StepWire | None = None
        self._wakeup: Wakeup | None = None
        self._next: Grant | None = None  # granted, but not all is here that was sent
        self._is_over = False
        self._waiting = Stopwatch()
        self.say_after_s = SAY_AFTER_S
        self._silence = Stopwatch()
        self._said = ""

    @property
    def wire(self) -> StepWire:
        """How the others are reached.

        Raises:
            LockStepError: the context has not joined the network.
        """
        if self._wire is None:
            raise LockStepError("lock-step: the context is not on the network")
        return self._wire

    @abstractmethod
    def join(self, wire: StepWire) -> None:
        """Take part; before the first node is announced."""

    def go_to(self, target_ns: int | None, wakeup: Wakeup) -> bool:
        """As the base class; time waits at the end of a step for the others.

        Raises:
            LockStepError: somebody is gone or does not answer.
        """
        self._wakeup = wakeup
        if target_ns is not None and target_ns <= self._granted_ns:
            self.now_ns = max(self.now_ns, target_ns)
            return True
        self.now_ns = self._granted_ns
        if self._next is not None and self.traffic.held.is_complete():
            self._begin(self._next)
        else:
            self._await(self.wire.census(), wakeup)
        return False

    def _await(self, census: Census, wakeup: Wakeup) -> None:
        if wakeup.is_pending:  # what came with the census is looked at first
            return
        if not (self._is_over or (self._next is not None and self._next.is_last)):
            self._check_there(census)
        if self._next is None:
            self._await_others(census, wakeup)
        else:
            self._await_samples(wakeup)

    @abstractmethod
    def _check_there(self, census: Census) -> None:
        """Raise LockStepError if somebody that is needed is gone."""

    @abstractmethod
    def _await_others(self, census: Census, wakeup: Wakeup) -> None:
        """Nothing is left to do in this step."""

    def _take(self, grant: Grant) -> None:
        """A step may begin, when all is here that was sent in the one before."""
        self._waiting = Stopwatch()
        if self.traffic.held.expect(grant.sent):
            self._begin(grant)
        else:
            self._next = grant

    def _await_samples(self, wakeup: Wakeup) -> None:
        if not wakeup.wait(self._patience_s):
            missing = ", ".join(
                f"{m.samples} of {m.topic} by {m.node}"
                for m in self.traffic.held.missing()[:10]
            )
            raise LockStepError(
                f"lock-step: messages did not arrive within {self.limit_s:g} s at "
                f"{self.now_ns / 1e9:g} s: {missing}"
            )

    def _begin(self, grant: Grant) -> None:
        self._next = None
        self.step = grant.step
        self._granted_ns = grant.until_ns
        self._is_over = grant.is_last
        self.traffic.tally.granted(grant.sent)
        self._waiting = Stopwatch()
        self.traffic.held.release(self.now_ns)

    def _own_report(self, census: Census) -> Report:
        sent = self.traffic.tally.changed()
        return Report(self.step, census.nodes, census.own, census.seen, sent)

    @property
    def _patience_s(self) -> float:
        """What is left of the limit."""
        return max(0.0, self.limit_s - self._waiting.elapsed_s)

    def _wake(self) -> None:
        if self._wakeup is not None:
            self._wakeup.set()

    def _say(self, text: str) -> None:
        """Log what is waited for, when it has been for a while, and once."""
        if text != self._said and self._silence.elapsed_s >= self.say_after_s:
            self._said, self._silence = text, Stopwatch()
            _log.warning("lock-step: %s", text)


def _nothing() -> None:
    """Nobody asked."""
