"""Output of the processes of a launch, while it runs (``proc_output``)."""

from collections.abc import Iterator
from threading import Condition, RLock
from typing import Any

from navette.ros2.packages.launch.events.process import ProcessIO
from navette.ros2.packages.launch_testing.asserts import assertInStream
from navette.ros2.packages.launch_testing.process_selection import (
    NoMatchingProcessException,
    resolveProcesses,
)


class IoHandler:
    """Events of output, by process."""

    def __init__(self) -> None:
        self._events: dict[Any, list[ProcessIO]] = {}

    def track(self, action: Any) -> None:
        """Add a process that has not written anything yet."""
        self._events.setdefault(action, [])

    def append(self, process_io: ProcessIO) -> None:
        self._events.setdefault(process_io.action, []).append(process_io)

    def __iter__(self) -> Iterator[ProcessIO]:
        return iter([each for events in self._events.values() for each in events])

    def processes(self) -> list[Any]:
        """Return the actions of the processes."""
        return list(self._events)

    def process_names(self) -> list[str]:
        """Return the names of the processes (``talker-1``)."""
        return [action.process_details["name"] for action in self._events]

    def __getitem__(self, key: Any) -> list[ProcessIO]:
        """Return the events of a process, given by action or by name."""
        found = resolveProcesses(self, process=key)
        return list(self._events[found[0]])


class ActiveIoHandler(IoHandler):
    """Events of output of a launch in another thread."""

    def __init__(self) -> None:
        super().__init__()
        self._changed = Condition(RLock())

    @property
    def io_event(self) -> Condition:
        """Notified at each event."""
        return self._changed

    def track(self, action: Any) -> None:
        with self._changed:
            super().track(action)
            self._changed.notify_all()

    def append(self, process_io: ProcessIO) -> None:
        with self._changed:
            super().append(process_io)
            self._changed.notify_all()

    def waitFor(  # noqa: N802 - ROS 2's name
        self, expected_output: Any, *args: Any, timeout: float = 10, **kwargs: Any
    ) -> bool:
        """Return whether output arrives within ``timeout`` seconds.

        Args:
            expected_output: see :func:`make_matcher`.
            args, kwargs: of ``assertInStream``: process, stream and so on.
        """
        stream = kwargs.pop("stream", "stderr")
        process = args[0] if args else kwargs.pop("process", None)
        rest = args[1:]

        def is_there() -> bool:
            try:
                assertInStream(
                    self, expected_output, process, *rest, stream=stream, **kwargs
                )
            except (AssertionError, NoMatchingProcessException):
                return False
            return True

        with self._changed:
            return self._changed.wait_for(is_there, timeout)

    def assertWaitFor(  # noqa: N802 - ROS 2's name
        self, expected_output: Any, *args: Any, timeout: float = 10, **kwargs: Any
    ) -> None:
        """Fail if :meth:`waitFor` returns False."""
        if not self.waitFor(expected_output, *args, timeout=timeout, **kwargs):
            written = "".join(e.text.decode(errors="replace") for e in self)
            raise AssertionError(
                f"{expected_output!r} not found in "
                f"{kwargs.get('stream', 'stderr')} within {timeout} s; output so far: "
                f"{written[-2000:]!r}"
            )
