"""Runner of tests beside a launch: start, wait until ready, test, shut down, test."""

import unittest
from collections.abc import Sequence
from threading import Event, Thread
from typing import Any

from navette.ros2.packages.launch import LaunchDescription, LaunchService
from navette.ros2.packages.launch.actions import RegisterEventHandler
from navette.ros2.packages.launch.event_handlers import (
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
)
from navette.ros2.packages.launch_testing.io_handler import ActiveIoHandler
from navette.ros2.packages.launch_testing.loader import TestRun
from navette.ros2.packages.launch_testing.proc_info_handler import (
    ActiveProcInfoHandler,
)

_END_S = 60.0


class LaunchTestRunner:
    """Runs test runs one after another.

    Args:
        test_runs: result of ``LoadTestsFromPythonModule``.
        launch_file_arguments: ``name:=value`` arguments.
        debug: print debug messages of the launch.
    """

    def __init__(
        self,
        test_runs: Sequence[TestRun],
        launch_file_arguments: Sequence[str] = (),
        debug: bool = False,
    ) -> None:
        self._runs = list(test_runs)
        self._arguments = list(launch_file_arguments)
        self._debug = debug

    def validate(self) -> None:
        """Check that each description can be made and has one ReadyToTest.

        Raises:
            Exception: what the description's function raised.
        """
        for run in self._runs:
            run.describe(lambda: None)

    def run(self) -> dict[TestRun, unittest.TestResult]:
        """Return the results of the test runs."""
        return {
            run: _Run(run, self._arguments, self._debug).run() for run in self._runs
        }


class _Run:
    """One test run."""

    def __init__(self, run: TestRun, arguments: list[str], debug: bool) -> None:
        self._run = run
        self._result = unittest.TestResult()
        self._ready = Event()
        self._over = Event()
        self._info, self._output = ActiveProcInfoHandler(), ActiveIoHandler()
        self._service = LaunchService(argv=arguments, debug=debug)
        description, context = run.describe(self._ready.set)
        self._service.include_launch_description(
            LaunchDescription([*self._handlers(), description])
        )
        words = (word.partition(":=") for word in arguments)
        self._values = {
            **context,
            "launch_service": self._service,
            "proc_info": self._info,
            "proc_output": self._output,
            "test_args": {name: value for name, _, value in words},
        }

    def _handlers(self) -> list[Any]:
        def started(event: Any, context: Any) -> None:
            self._info.append(event)
            self._output.track(event.process_name)

        def exited(event: Any, context: Any) -> None:
            self._info.append(event)

        output = self._output.append
        return [
            RegisterEventHandler(handler)
            for handler in (
                OnProcessStart(on_start=started),
                OnProcessExit(on_exit=exited),
                OnProcessIO(on_stdout=output, on_stderr=output),
            )
        ]

    def run(self) -> unittest.TestResult:
        launch = Thread(target=self._launch, name="launch_testing", daemon=True)
        launch.start()
        try:
            self._test_beside_the_launch()
        finally:
            self._service.shutdown(reason="the tests are over")
            launch.join(_END_S)
        self._run_suite(self._run.post_shutdown_tests)
        return self._result

    def _launch(self) -> None:
        try:
            keep_alive = bool(self._run.markers.get("keep_alive"))
            self._service.run(shutdown_when_idle=not keep_alive)
        finally:
            self._over.set()
            self._ready.set()

    def _test_beside_the_launch(self) -> None:
        is_ready = self._ready.wait(self._run.timeout)
        if not is_ready or self._over.is_set():
            state = "ended" if is_ready else f"took {self._run.timeout:g} s"
            self._fail(f"the launch {state} before ReadyToTest was executed")
            return
        self._run_suite(self._run.pre_shutdown_tests)
        if self._over.is_set():
            self._fail(
                "the processes under test ended before the tests; add "
                "launch_testing.util.KeepAliveProc() to the description"
            )

    def _run_suite(self, suite: unittest.TestSuite) -> None:
        self._run.bind(suite, self._values)
        suite.run(self._result)

    def _fail(self, reason: str) -> None:
        causes = "".join(f"\n{error}" for error in self._service.errors)

        def fail() -> None:
            raise AssertionError(f"{self._run}: {reason}{causes}")

        unittest.FunctionTestCase(fail, description=reason).run(self._result)
