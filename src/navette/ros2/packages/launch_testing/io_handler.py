"""Output of the processes of a launch, while it runs (``proc_output``)."""

from collections.abc import Iterator
from threading import Condition, RLock
from typing import Any

from navette.ros2.packages.launch.events.process import ProcessIO
from navette.ros2.packages.launch_testing.asserts import assertInStream
from navette.ros2.packages.launch_testing.process_selection import (
    NoMatchingProcessException,
)


class IoHandler:
    """Events of output, by name of the process."""

    def __init__(self) -> None:
        self._sequence: list[ProcessIO] = []
        self._names: dict[str, None] = {}

    def track(self, process_name: str) -> None:
        """Add a process that has not written anything yet."""
        self._names[process_name] = None

    def append(self, process_io: ProcessIO) -> None:
        self._sequence.append(process_io)
        self._names[process_io.process_name] = None

    def __iter__(self) -> Iterator[ProcessIO]:
        """Iterate over all events in their order."""
        return iter(list(self._sequence))

    def processes(self) -> list[Any]:
        """Return the actions of the processes that have written something."""
        return list(dict.fromkeys(event.action for event in self._sequence))

    def process_names(self) -> list[str]:
        """Return the names of the processes (``talker-1``)."""
        return list(self._names)

    def __getitem__(self, key: Any) -> list[ProcessIO]:
        """Return the events of a process, given by action or by name.

        Raises:
            KeyError: no such process.
        """
        name = key if isinstance(key, str) else key.process_details["name"]
        if name not in self._names:
            raise KeyError(name)
        return [event for event in self._sequence if event.process_name == name]


class ActiveIoHandler(IoHandler):
    """Events of output of a launch in another thread."""

    def __init__(self) -> None:
        super().__init__()
        self._changed = Condition(RLock())

    @property
    def io_event(self) -> Condition:
        """Notified at each event."""
        return self._changed

    def track(self, process_name: str) -> None:
        with self._changed:
            super().track(process_name)
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
