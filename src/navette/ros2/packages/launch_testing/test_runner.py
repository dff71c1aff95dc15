"""Runner of tests beside a launch: start, wait until ready, test, shut down, test."""

import sys
import unittest
from collections.abc import Callable, Sequence
from threading import Event, Thread
from typing import Any

from navette.ros2.packages.launch import LaunchDescription, LaunchService
from navette.ros2.packages.launch.actions import RegisterEventHandler
from navette.ros2.packages.launch.event_handlers import (
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
)
from navette.ros2.packages.launch.events.process import ProcessExited
from navette.ros2.packages.launch_testing.io_handler import ActiveIoHandler
from navette.ros2.packages.launch_testing.loader import TestRun
from navette.ros2.packages.launch_testing.parse_arguments import parse_launch_arguments
from navette.ros2.packages.launch_testing.proc_info_handler import (
    ActiveProcInfoHandler,
)
from navette.ros2.packages.launch_testing.test_result import (
    FailResult,
    SkipResult,
    TestResult,
)

# Programs replace a step of the worker.
__all__ = ["LaunchTestRunner", "_RunnerWorker"]

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

    def generate_preamble(self) -> list[Any]:
        """Return entities that each launch visits first; subclasses replace it."""
        return []

    def validate(self) -> None:
        """Check the arguments of the descriptions' functions.

        Raises:
            TypeError: names an argument.
        """
        for run in self._runs:
            run.check_signature()

    def run(self) -> dict[TestRun, unittest.TestResult]:
        """Return the results of the test runs; one that cannot run ends the list."""
        results: dict[TestRun, unittest.TestResult] = {}
        for run in self._runs:
            try:
                worker = _RunnerWorker(
                    run, self.generate_preamble(), self._arguments, self._debug
                )
                results[run] = worker.run()
            except unittest.SkipTest as skip:
                results[run] = SkipResult(run, str(skip))
            except _LaunchEndedError as ended:
                results[run] = FailResult(run, str(ended))
                break
        return results


class _LaunchEndedError(Exception):
    """The launch ended before its tests."""


class _RunnerWorker:
    """One test run."""

    def __init__(
        self, test_run: TestRun, preamble: list[Any], arguments: list[str], debug: bool
    ) -> None:
        self._test_run = test_run
        self._ready = Event()
        self._over = Event()
        self._info, self._output = ActiveProcInfoHandler(), ActiveIoHandler()
        self._service = LaunchService(argv=arguments, debug=debug)
        self._result: TestResult | None = None
        self._problem = "the processes under test ended before the tests"
        description, self._context = test_run.normalized_test_description(
            ready_fn=self._ready.set
        )
        self._service.include_launch_description(
            LaunchDescription([*preamble, *self._handlers(), description])
        )
        self._test_args = dict(parse_launch_arguments(arguments))
        self._service.context.launch_configurations.update(self._test_args)

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

    def run(self) -> TestResult:
        """Return the results of the tests beside the launch and after it.

        Raises:
            _LaunchEndedError: the launch ended, or was not ready, before the tests.
        """
        launch = Thread(target=self._launch, name="launch_testing", daemon=True)
        launch.start()
        self._run_test()
        launch.join(_END_S)
        if self._result is None:
            self._print_failed_processes()
            raise _LaunchEndedError(self._describe_end())
        self._result.append(self._run_suite(self._test_run.post_shutdown_tests))
        return self._result

    def _launch(self) -> None:
        try:
            keep_alive = bool(self._test_run.markers.get("keep_alive"))
            self._service.run(shutdown_when_idle=not keep_alive)
        finally:
            self._over.set()
            self._ready.set()

    def _run_test(self) -> None:
        """Run the tests beside the launch, then shut it down."""
        try:
            if not self._ready.wait(self._test_run.timeout):
                timeout_s = self._test_run.timeout
                self._problem = f"ReadyToTest was not executed within {timeout_s:g} s"
            elif not self._over.is_set():
                result = self._run_suite(self._test_run.pre_shutdown_tests)
                if not self._over.is_set():
                    self._result = result
        finally:
            self._service.shutdown(reason="the tests are over")

    def _run_suite(self, suite: unittest.TestSuite) -> TestResult:
        values = {
            "proc_info": self._info,
            "proc_output": self._output,
            "launch_service": self._service,
            "test_args": self._test_args,
        }
        self._test_run.bind(
            suite, injected_attributes=values, injected_args=self._context | values
        )
        make: Callable[..., TestResult] = TestResult
        runner = unittest.TextTestRunner(verbosity=2, resultclass=make)
        result = runner.run(suite)
        assert isinstance(result, TestResult), "of resultclass"
        return result

    def _describe_end(self) -> str:
        causes = "".join(f"\n{error}" for error in self._service.errors)
        return (
            f"{self._test_run}: {self._problem}{causes}; the output of failed "
            "processes is above; launch_testing.util.KeepAliveProc() in the "
            "description keeps a launch running whose processes end"
        )

    def _print_failed_processes(self) -> None:
        for event in self._info:
            if not isinstance(event, ProcessExited) or event.returncode == 0:
                continue
            written = [
                io.text for io in self._output if io.process_name == event.process_name
            ]
            text = b"".join(written).decode(errors="replace")
            sys.stdout.write(
                f"process {event.process_name} ended with code {event.returncode}; "
                f"its output:\n{text}\n"
            )
