"""Events of processes, requests to processes, and matchers that select them."""

import re
import signal
from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import Event

__all__ = [
    "ProcessExited",
    "ProcessIO",
    "ProcessStarted",
    "ProcessStderr",
    "ProcessStdin",
    "ProcessStdout",
    "ProcessTargetedEvent",
    "RunningProcessEvent",
    "ShutdownProcess",
    "SignalProcess",
    "matches_executable",
    "matches_name",
    "matches_pid",
]


class RunningProcessEvent(Event):
    """Event of a process that ``action`` started.

    ``pid`` is this process's own for a program that runs as a thread.
    """

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: Any,
        name: str,
        cmd: list[str],
        cwd: str | None,
        env: dict[str, str] | None,
        pid: int,
    ) -> None:
        self.action = action
        self.process_name = name
        self.cmd = cmd
        self.cwd = cwd
        self.env = env
        self.pid = pid

    @property
    def execute_process_action(self) -> Any:
        return self.action


class ProcessStarted(RunningProcessEvent):
    """The process started."""

    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """The process exited with ``returncode``."""

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **details: Any) -> None:
        super().__init__(**details)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """The process wrote ``text``, or received it."""

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int, **details: Any) -> None:
        super().__init__(**details)
        self.text = text
        self.fd = fd

    @property
    def from_stdin(self) -> bool:
        return self.fd == 0

    @property
    def from_stdout(self) -> bool:
        return self.fd == 1

    @property
    def from_stderr(self) -> bool:
        return self.fd == 2


class ProcessStdout(ProcessIO):
    """The process wrote to its standard output."""

    name = "launch.events.process.ProcessStdout"

    def __init__(self, *, text: bytes, **details: Any) -> None:
        super().__init__(text=text, fd=1, **details)


class ProcessStderr(ProcessIO):
    """The process wrote to its standard error."""

    name = "launch.events.process.ProcessStderr"

    def __init__(self, *, text: bytes, **details: Any) -> None:
        super().__init__(text=text, fd=2, **details)


Matcher = Callable[[Any], bool]


class ProcessTargetedEvent(Event):
    """Request to the processes whose actions ``process_matcher`` selects."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Matcher) -> None:
        self.process_matcher = process_matcher


class ShutdownProcess(ProcessTargetedEvent):
    """Request to end: SIGINT, then SIGTERM, then SIGKILL."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """Request to send a signal, given by name or number."""

    name = "launch.events.process.SignalProcess"

    def __init__(self, *, signal_number: str | int, process_matcher: Matcher) -> None:
        super().__init__(process_matcher=process_matcher)
        try:
            self.signal = (
                signal.Signals[signal_number]
                if isinstance(signal_number, str)
                else signal.Signals(signal_number)
            )
        except (KeyError, ValueError):
            names = ", ".join(sorted(each.name for each in signal.Signals))
            raise InvalidLaunchValueError(
                f"SignalProcess: signal {signal_number!r}; known: {names}"
            ) from None
        self.signal_name = self.signal.name


class ProcessStdin(ProcessTargetedEvent):
    """Request to write ``text`` to the standard input."""

    name = "launch.events.process.ProcessStdin"

    def __init__(self, *, text: bytes, process_matcher: Matcher) -> None:
        super().__init__(process_matcher=process_matcher)
        self.text = text
        self.fd = 0


def matches_pid(pid: int) -> Matcher:
    """Return a matcher of the process with this id."""
    return lambda action: (action.process_details or {}).get("pid") == pid


def matches_name(name: str) -> Matcher:
    """Return a matcher of processes with this label (``talker-1``)."""
    return lambda action: (action.process_details or {}).get("name") == name


def matches_executable(executable: str) -> Matcher:
    """Return a matcher of processes by the file name of their executable."""

    def matches(action: Any) -> bool:
        cmd = (action.process_details or {}).get("cmd") or [""]
        return re.split(r"[/\\]", cmd[0])[-1] == executable

    return matches
