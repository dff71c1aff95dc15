"""A launch that runs beside tests, in a thread."""

from collections.abc import Sequence
from threading import Event, Thread
from typing import Any

from navette.ros2.packages.launch import LaunchDescription, LaunchService
from navette.ros2.packages.launch.launch_description import walk
from navette.ros2.packages.launch_testing.actions import ReadyToTest

READY_TIMEOUT_S = 15.0
_END_S = 60.0


class RunningLaunch:
    """A launch from its start to its shutdown.

    Args:
        fixture: what the fixture returned: a description, or a list that starts with
            one; further items are awaitables or events to wait for.
    """

    def __init__(self, fixture: Any) -> None:
        self._ready, self._over = Event(), Event()
        self._ready_action: ReadyToTest | None = None
        description = self._description(fixture)
        self.service = LaunchService()
        self.service.include_launch_description(description)
        self._thread = Thread(target=self._run, name="launch_pytest", daemon=True)

    def _description(self, fixture: Any) -> LaunchDescription:
        is_list = isinstance(fixture, Sequence) and bool(fixture)
        description = fixture[0] if is_list else fixture
        if not isinstance(description, LaunchDescription):
            raise RuntimeError(
                "the fixture's value must be either a launch description, or a list "
                f"that starts with one; it is {fixture!r}"
            )
        ready = [each for each in walk(description) if isinstance(each, ReadyToTest)]
        if len(ready) > 1:
            raise RuntimeError(
                f"a launch description has only one ReadyToTest action; this one has "
                f"{len(ready)}"
            )
        for each in ready:
            each._add_callback(self._ready.set)
        if not ready:
            self._ready.set()
        return description

    def start(self) -> None:
        """Start the launch and wait for its ReadyToTest.

        Raises:
            RuntimeError: the launch failed or did not get ready in time.
        """
        self._thread.start()
        if not self._ready.wait(READY_TIMEOUT_S):
            self.shut_down()
            raise RuntimeError(f"ReadyToTest did not run within {READY_TIMEOUT_S:g} s")
        if self.service.errors:
            raise RuntimeError("; ".join(map(str, self.service.errors)))

    def _run(self) -> None:
        try:
            self.service.run(shutdown_when_idle=False)
        finally:
            self._over.set()
            self._ready.set()

    def shut_down(self) -> None:
        """End the launch; a second call does nothing."""
        if not self._over.is_set():
            self.service.shutdown(reason="the tests are over")
            self._thread.join(_END_S)
