"""Actions of test descriptions."""

from collections.abc import Callable, Iterable
from typing import Any

from navette.ros2.packages.launch import Action, LaunchContext
from navette.ros2.packages.launch.actions import ExecuteProcess, TimerAction
from navette.ros2.packages.launch.actions.events import EmitEvent
from navette.ros2.packages.launch.event_handlers import OnProcessExit
from navette.ros2.packages.launch.events import matches_action
from navette.ros2.packages.launch.events.process import ShutdownProcess

__all__ = ["GTest", "PyTest", "ReadyToTest", "Test"]


class ReadyToTest(Action):
    """Starts the tests; a description has exactly one."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._callbacks: list[Callable[[], Any]] = []

    def _add_callback(self, callback: Callable[[], Any]) -> None:
        self._callbacks.append(callback)

    def execute(self, context: LaunchContext) -> None:
        for callback in self._callbacks:
            callback()


class Test(ExecuteProcess):
    """A test that is a program: the launch ends it after ``timeout`` seconds."""

    __test__ = False  # not a class of pytest's

    def __init__(self, *, timeout: float | None = None, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._timeout = timeout

    @property
    def timeout(self) -> float | None:
        return self._timeout

    def execute(self, context: LaunchContext) -> Any:
        found = super().execute(context)
        if self._timeout is not None:
            end = EmitEvent(event=ShutdownProcess(process_matcher=matches_action(self)))
            timer = TimerAction(period=self._timeout, actions=[end])

            def cancel(event: Any, context: LaunchContext) -> None:
                timer.cancel()

            timer.execute(context)
            context.register_event_handler(
                OnProcessExit(target_action=self, on_exit=cancel, handle_once=True)
            )
        return found


class GTest(Test):
    """A program of googletest at ``path``."""

    def __init__(self, *, path: Any, args: Iterable[Any] = (), **kwargs: Any) -> None:
        super().__init__(cmd=[path, *args], **kwargs)
        self.path = path


class PyTest(Test):
    """Tests of pytest in the file or folder ``path``."""

    def __init__(self, *, path: Any, args: Iterable[Any] = (), **kwargs: Any) -> None:
        super().__init__(cmd=["pytest", path, *args], **kwargs)
        self.path = path
