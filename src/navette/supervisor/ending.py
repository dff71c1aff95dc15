"""Ending a process: asked first, then with more force."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from navette.supervisor.child import INTERRUPT, KILL, TERMINATE

_STEPS = (INTERRUPT, TERMINATE, KILL)
SIGNAL_NAMES = {INTERRUPT: "SIGINT", TERMINATE: "SIGTERM", KILL: "SIGKILL"}


@dataclass(frozen=True)
class Patience:
    """How long a process that was asked to end may take, seconds.

    ``interrupt_s``: from SIGINT to SIGTERM; ``terminate_s``: from there to SIGKILL.
    """

    interrupt_s: float = 5.0
    terminate_s: float = 5.0


class Cancellable(Protocol):
    """A call that is to happen later."""

    def cancel(self) -> None: ...


class Ending:
    """Sends SIGINT, SIGTERM and SIGKILL in turn until :meth:`cancel`.

    Args:
        send: sends a signal.
        later: calls a function after so many seconds.
        on_force: told the name of each signal but the first.
    """

    def __init__(
        self,
        patience: Patience,
        send: Callable[[int], None],
        later: Callable[[float, Callable[[], None]], Cancellable],
        on_force: Callable[[str], None],
    ) -> None:
        self._patience = patience
        self._send = send
        self._later = later
        self._on_force = on_force
        self._strength = 0
        self._next: Cancellable | None = None

    @property
    def has_begun(self) -> bool:
        return self._strength > 0

    def go_on(self) -> None:
        """Send the next signal now; the one after it comes by itself in time."""
        self.cancel()
        number = _STEPS[min(self._strength, len(_STEPS) - 1)]
        self._strength += 1
        if self._strength > 1:
            self._on_force(SIGNAL_NAMES[number])
        self._send(number)
        if number != KILL:
            patience = self._patience
            left_s = (
                patience.interrupt_s if number == INTERRUPT else patience.terminate_s
            )
            self._next = self._later(left_s, self.go_on)

    def cancel(self) -> None:
        """It has ended: nothing more is sent."""
        if self._next is not None:
            self._next.cancel()
            self._next = None
