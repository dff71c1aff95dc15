"""Service that runs a launch until its tests have finished."""

from collections.abc import Callable, Container
from enum import Enum
from typing import Any

from navette.ros2.packages.launch import LaunchDescription, LaunchService
from navette.ros2.packages.launch.actions import ExecuteProcess, RegisterEventHandler
from navette.ros2.packages.launch.actions.events import EmitEvent
from navette.ros2.packages.launch.event_handlers import (
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnShutdown,
)
from navette.ros2.packages.launch.events import Shutdown
from navette.ros2.packages.launch_testing.legacy.output import OutputTest


class _State(Enum):
    RUNNING = "running"
    OVER = "over"
    FAILED = "failed"


class LaunchTestService:
    """Adds fixtures and tests to a description, and runs it.

    The launch is shut down when a fixture ends, when a test fails, and when all tests
    are over.
    """

    def __init__(self) -> None:
        self._tests: dict[str, _State] = {}
        self._codes: list[int] = []

    def add_fixture_action(
        self,
        launch_description: LaunchDescription,
        action: Any,
        exit_allowed: Container[int] | bool = (0,),
    ) -> Any:
        """Add an action that tests need.

        Args:
            exit_allowed: exit codes of a process that do not end the launch; True: all.
        """
        launch_description.add_action(action)
        if isinstance(action, ExecuteProcess):

            def on_exit(event: Any, context: Any) -> Any:
                code = event.returncode
                if isinstance(exit_allowed, bool):
                    is_allowed = exit_allowed
                else:
                    is_allowed = code in exit_allowed
                if context.is_shutdown or is_allowed:
                    return None
                self._codes.append(code or 1)
                return _shutdown(f"fixture {event.process_name} ended with {code}")

            _handle(
                launch_description, OnProcessExit(target_action=action, on_exit=on_exit)
            )
        return action

    def add_test_action(
        self, launch_description: LaunchDescription, action: Any
    ) -> Any:
        """Add an action that is a test: a process passes with exit code 0."""
        name = self._start(action)
        handler: Any
        if isinstance(action, ExecuteProcess):

            def on_exit(event: Any, context: Any) -> Any:
                if event.returncode == 0:
                    return self._finish(name)
                self._codes.append(event.returncode)
                return self._fail(name, f"test {event.process_name} failed")

            handler = OnProcessExit(target_action=action, on_exit=on_exit)
        else:

            def on_completion(event: Any, context: Any) -> Any:
                future = event.action.get_asyncio_future()
                if future is not None and not future.cancelled() and future.exception():
                    return self._fail(name, str(future.exception()))
                return self._finish(name)

            handler = OnExecutionComplete(
                target_action=action, on_completion=on_completion
            )
        _handle(launch_description, handler)
        launch_description.add_action(action)
        return action

    def add_output_test(
        self,
        launch_description: LaunchDescription,
        action: ExecuteProcess,
        output_test: OutputTest,
        test_suffix: str = "output",
        output_filter: Callable[[bytes], bytes] | None = None,
        side_effect: str | None = None,
    ) -> ExecuteProcess:
        """Add a test of the standard output of a process.

        Args:
            output_test: result of a function of ``launch_testing.legacy.output``.
            test_suffix: distinguishes several tests of one process.
            output_filter: applied to each piece of output.
            side_effect: ``shutdown``: end the launch when the test has passed.
        """
        name = self._start(action, test_suffix)
        output, collate, matches, expected = output_test
        missing = list(expected)

        def on_output(event: Any) -> Any:
            text = event.text if output_filter is None else output_filter(event.text)
            collate(output, text)
            missing[:] = [each for each in missing if not matches(output, each)]
            if missing or self._tests[name] is not _State.RUNNING:
                return None
            if side_effect == "shutdown":
                self._tests[name] = _State.OVER
                return _shutdown("the output of the test is complete")
            return self._finish(name)

        def on_exit(event: Any, context: Any) -> Any:
            # Output that arrives after the exit still counts.
            return self._finish(name)

        def on_shutdown(event: Any, context: Any) -> None:
            if missing:
                self._tests[name] = _State.FAILED

        for handler in (
            OnProcessIO(target_action=action, on_stdout=on_output),
            OnProcessExit(target_action=action, on_exit=on_exit),
            OnShutdown(on_shutdown=on_shutdown),
        ):
            _handle(launch_description, handler)
        return action

    def run(self, launch_service: LaunchService, *args: Any, **kwargs: Any) -> int:
        """Run the launch; return 0 if it and all tests succeed."""
        code = launch_service.run(*args, **kwargs)
        if code == 0:
            has_failed = _State.FAILED in self._tests.values()
            code = next(iter(self._codes), 1 if has_failed else 0)
        return code

    def _start(self, action: Any, suffix: str = "") -> str:
        name = f"{id(action)} {suffix}"
        if name in self._tests:
            raise ValueError(f"{action.describe()} has a test {suffix!r} already")
        self._tests[name] = _State.RUNNING
        return name

    def _finish(self, name: str) -> Any:
        if self._tests[name] is _State.RUNNING:
            self._tests[name] = _State.OVER
        is_over = _State.RUNNING not in self._tests.values()
        return _shutdown("all tests are over") if is_over else None

    def _fail(self, name: str, reason: str) -> Any:
        self._tests[name] = _State.FAILED
        return _shutdown(reason)


def _shutdown(reason: str) -> list[Any]:
    return [EmitEvent(event=Shutdown(reason=reason))]


def _handle(description: LaunchDescription, handler: Any) -> None:
    description.add_action(RegisterEventHandler(handler))
