"""Termination of a process: SIGINT, then SIGTERM, then SIGKILL."""

from dataclasses import dataclass
from typing import Protocol

from navette.runtime.events import Call
from navette.runtime.loop import EventLoop
from navette.supervisor.child import INTERRUPT, KILL, TERMINATE

_STEPS = (INTERRUPT, TERMINATE, KILL)
SIGNAL_NAMES = {INTERRUPT: "SIGINT", TERMINATE: "SIGTERM", KILL: "SIGKILL"}


@dataclass(frozen=True)
class GracePeriods:
    """How long a process may take to end, in seconds.

    Attributes:
        interrupt_s: from SIGINT to SIGTERM.
        terminate_s: from SIGTERM to SIGKILL.
    """

    interrupt_s: float = 5.0
    terminate_s: float = 5.0


class TerminationTarget(Protocol):
    """The process to terminate."""

    label: str

    def signal(self, number: int) -> None: ...

    def on_escalated(self, signal_name: str) -> None:
        """Handle that a signal after the first is about to be sent."""


class Terminator:
    """Sends SIGINT, SIGTERM and SIGKILL in turn until :meth:`cancel`."""

    def __init__(
        self, grace: GracePeriods, target: TerminationTarget, loop: EventLoop
    ) -> None:
        self._grace = grace
        self._target = target
        self._loop = loop
        self._step = 0
        self._timer: Call | None = None

    def send_next(self) -> None:
        """Send the next signal now; the one after it follows its grace period."""
        self.cancel()
        number = _STEPS[min(self._step, len(_STEPS) - 1)]
        self._step += 1
        if self._step > 1:
            self._target.on_escalated(SIGNAL_NAMES[number])
        self._target.signal(number)
        if number != KILL:
            grace = self._grace
            wait_s = grace.interrupt_s if number == INTERRUPT else grace.terminate_s
            at_ns = self._loop.clock.now_ns + round(wait_s * 1e9)
            source = f"termination of {self._target.label}"
            self._timer = self._loop.call_at(at_ns, self.send_next, source)

    def cancel(self) -> None:
        """Send no more signals."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
