"""One run of a command: from its start over its output to its end."""

from typing import TYPE_CHECKING, Any

from navette.ros2.packages.launch.events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdout,
)
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.output import LabelledOutput
from navette.ros2.packages.launch.running import Command, Running
from navette.supervisor import Ending, Patience

if TYPE_CHECKING:
    from collections.abc import Callable

    from navette.ros2.packages.launch.launch_context import LaunchContext


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
        self._on_exit = on_exit
        self._log = get_logger(command.label)
        self._ending = Ending(
            patience,
            self.signal,
            lambda s, do: context.call_after(s, do, f"end of {command.label}"),
            lambda name: self._log.warning("does not end; sending %s", name),
        )
        self.running: Running | None = None
        self.return_code: int | None = None

    @property
    def was_asked_to_end(self) -> bool:
        return self._ending.has_begun

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
        if self.running is not None and self.return_code is None:
            self._ending.go_on()

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
        self._ending.cancel()
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
