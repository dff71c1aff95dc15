"""Starts and exits of the processes of a launch (``proc_info``)."""

from collections.abc import Callable, Iterator
from threading import Condition, RLock
from typing import Any

from navette.ros2.packages.launch.events.process import (
    ProcessExited,
    ProcessStarted,
    RunningProcessEvent,
)
from navette.ros2.packages.launch_testing.process_selection import (
    NoMatchingProcessException,
    resolveProcesses,
)


class ProcInfoHandler:
    """The last event of each process: its start or its exit."""

    def __init__(self) -> None:
        self._events: dict[Any, RunningProcessEvent] = {}

    def append(self, process_info: RunningProcessEvent) -> None:
        self._events[process_info.action] = process_info

    def __iter__(self) -> Iterator[RunningProcessEvent]:
        return iter(list(self._events.values()))

    def processes(self) -> list[Any]:
        """Return the actions of the processes."""
        return list(self._events)

    def process_names(self) -> list[str]:
        """Return the names of the processes (``talker-1``)."""
        return [event.process_name for event in self._events.values()]

    def __getitem__(self, key: Any) -> RunningProcessEvent:
        """Return the last event of a process, given by action or by name.

        Raises:
            KeyError: no such process.
        """
        if not isinstance(key, str):
            return self._events[key]
        for event in self._events.values():
            if event.process_name == key:
                return event
        raise KeyError(key)


class ActiveProcInfoHandler(ProcInfoHandler):
    """Starts and exits of a launch in another thread."""

    def __init__(self) -> None:
        super().__init__()
        self._changed = Condition(RLock())

    @property
    def proc_event(self) -> Condition:
        """Notified at each event."""
        return self._changed

    def append(self, process_info: RunningProcessEvent) -> None:
        with self._changed:
            super().append(process_info)
            self._changed.notify_all()

    def assertWaitForShutdown(  # noqa: N802 - ROS 2's name
        self, process: Any, cmd_args: Any = None, *, timeout: float = 10
    ) -> None:
        """Fail if a process does not exit within ``timeout`` seconds."""
        self._wait_for("exit", (ProcessExited,), process, cmd_args, timeout)

    def assertWaitForStartup(  # noqa: N802 - ROS 2's name
        self, process: Any, cmd_args: Any = None, *, timeout: float = 10
    ) -> None:
        """Fail if a process does not start within ``timeout`` seconds."""
        kinds = (ProcessStarted, ProcessExited)
        self._wait_for("start", kinds, process, cmd_args, timeout)

    def _wait_for(
        self, what: str, kinds: Any, process: Any, cmd_args: Any, timeout: float
    ) -> None:
        def happened() -> bool:
            try:
                found = resolveProcesses(self, process=process, cmd_args=cmd_args)
            except NoMatchingProcessException:
                return False
            return all(isinstance(self._events[each], kinds) for each in found)

        predicate: Callable[[], bool] = happened
        with self._changed:
            if not self._changed.wait_for(predicate, timeout):
                shown = getattr(process, "name", None) or process
                raise AssertionError(
                    f"Timed out waiting for process {shown!r} to {what} within "
                    f"{timeout} s; processes: "
                    f"{', '.join(self.process_names()) or 'none'}"
                )
