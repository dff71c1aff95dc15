"""Events that ask something of running commands, and matchers that pick them."""

import re
import signal
from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import Event

Matcher = Callable[[Any], bool]


class ProcessTargetedEvent(Event):
    """For the commands that ``process_matcher`` picks by their actions."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Matcher) -> None:
        self.process_matcher = process_matcher


class ShutdownProcess(ProcessTargetedEvent):
    """They are to end: SIGINT, then SIGTERM, then SIGKILL."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """They get a signal, given by name or number."""

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
    """They get ``text`` on their standard input."""

    name = "launch.events.process.ProcessStdin"

    def __init__(self, *, text: bytes, process_matcher: Matcher) -> None:
        super().__init__(process_matcher=process_matcher)
        self.text = text
        self.fd = 0


def matches_pid(pid: int) -> Matcher:
    """Picks the command with this process id."""
    return lambda action: (action.process_details or {}).get("pid") == pid


def matches_name(name: str) -> Matcher:
    """Picks the commands of this name (``talker-1``)."""
    return lambda action: (action.process_details or {}).get("name") == name


def matches_executable(executable: str) -> Matcher:
    """Picks the commands whose executable's file has this name."""

    def matches(action: Any) -> bool:
        cmd = (action.process_details or {}).get("cmd") or [""]
        return re.split(r"[/\\]", cmd[0])[-1] == executable

    return matches
