"""One run of a command: from its start over its output to its end."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from navette.launch_files.launch.events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdout,
)
from navette.launch_files.launch.logging import get_logger
from navette.launch_files.launch.output import LabelledOutput
from navette.launch_files.launch.running import (
    INTERRUPT,
    KILL,
    TERMINATE,
    Command,
    Running,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from navette.launch_files.launch.launch_context import LaunchContext
    from navette.runtime.loop import Call

_NAMES = {INTERRUPT: "SIGINT", TERMINATE: "SIGTERM", KILL: "SIGKILL"}


@dataclass(frozen=True)
class Patience:
    """How long a command that was asked to end may take, seconds.

    ``interrupt_s``: from SIGINT to SIGTERM; ``terminate_s``: from there to SIGKILL.
    """

    interrupt_s: float = 5.0
    terminate_s: float = 5.0


class Execution:
    """A command under way, seen from the launch's loop.

    Args:
        action: what it belongs to; named in the events.
        on_exit: called on the loop once it has ended.
    """

    def __init__(
        self,
        action: Any,
        context: "LaunchContext",
        command: Command,
        output: LabelledOutput,
        patience: Patience,
        on_exit: "Callable[[Execution], None]",
    ) -> None:
        self._action = action
        self._context = context
        self.command = command
        self._output = output
        self._patience = patience
        self._on_exit = on_exit
        self._log = get_logger(command.label)
        self._escalation: Call | None = None
        self._strength = 0
        self.running: Running | None = None
        self.return_code: int | None = None

    @property
    def was_asked_to_end(self) -> bool:
        return self._strength > 0

    def start(self) -> None:
        """Start it, and say so."""
        self._context.busy.add(self)
        try:
            self.running = self._context.runner.start(self.command, self)
        except BaseException:
            self._context.busy.discard(self)
            raise
        self._log.info("process started with pid [%d]", self.running.pid)
        self._context.emit_event(ProcessStarted(**self.details))

    @property
    def details(self) -> dict[str, Any]:
        """What events tell of it."""
        env = self.command.env
        return {
            "action": self._action,
            "name": self.command.label,
            "cmd": self.command.words,
            "cwd": self.command.cwd,
            "env": None if env is None else dict(env),
            "pid": self.running.pid if self.running is not None else 0,
        }

    def end(self) -> None:
        """Ask it to end; a second time: at once with more force."""
        steps = (INTERRUPT, TERMINATE, KILL)
        number = steps[min(self._strength, 2)]
        self._strength += 1
        if self._escalation is not None:
            self._escalation.cancel()
            self._escalation = None
        if self.running is None or self.return_code is not None:
            return
        if self._strength > 1:
            self._log.warning("does not end; sending %s", _NAMES[number])
        self.running.signal(number)
        if number != KILL:
            patience = self._patience
            left_s = (
                patience.interrupt_s if number == INTERRUPT else patience.terminate_s
            )
            self._escalation = self._context.call_after(
                left_s, self.end, f"end of {self.command.label}"
            )

    def signal(self, number: int) -> None:
        """Send it a signal."""
        if self.running is not None and self.return_code is None:
            self.running.signal(number)

    def write(self, data: bytes) -> None:
        """Write to its standard input."""
        if self.running is not None and self.return_code is None:
            self.running.write(data)

    # -- told by the runner, from any thread -------------------------------------

    def output(self, stream: str, data: bytes) -> None:
        self._soon(lambda: self._take(stream, data))

    def exited(self, code: int) -> None:
        self._soon(lambda: self._end(code))

    def _soon(self, function: "Callable[[], None]") -> None:
        self._context.loop.call_soon_threadsafe(function, self.command.label)

    def _take(self, stream: str, data: bytes) -> None:
        self._output.write(stream, data)
        kind = ProcessStdout if stream == "stdout" else ProcessStderr
        self._context.emit_event(kind(text=data, **self.details))

    def _end(self, code: int) -> None:
        self.return_code = code
        if self._escalation is not None:
            self._escalation.cancel()
        self._output.close()
        self._say_how_it_ended(code)
        self._context.busy.discard(self)
        self._context.emit_event(ProcessExited(returncode=code, **self.details))
        self._on_exit(self)

    def _say_how_it_ended(self, code: int) -> None:
        pid = self.details["pid"]
        if code == 0:
            self._log.info("process has finished cleanly [pid %d]", pid)
        elif self.was_asked_to_end:
            self._log.info("process has ended [pid %d, exit code %d]", pid, code)
        else:
            self._context.failed_labels.append(self.command.label)
            self._log.error(
                "process has died [pid %d, exit code %d, cmd '%s']",
                pid,
                code,
                " ".join(self.command.words),
            )
