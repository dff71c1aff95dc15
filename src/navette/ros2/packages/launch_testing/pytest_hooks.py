"""pytest's collection of files with ``generate_test_description``."""

import importlib.util
import re
import unittest
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from navette.ros2.packages.launch_testing.loader import (
    FUNCTION,
    LoadTestsFromPythonModule,
    TestRun,
)
from navette.ros2.packages.launch_testing.test_result import FailResult
from navette.ros2.packages.launch_testing.test_runner import LaunchTestRunner


class LaunchTestError(AssertionError):
    """Tests of a launch failed; the text is their tracebacks."""


class LaunchTestItem(pytest.Item):
    """One launch with its tests.

    Args:
        run: the launch.
    """

    def __init__(self, *, run: TestRun, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._test_run = run

    def runtest(self) -> None:
        arguments = self.config.getoption("--launch-args")
        runner = LaunchTestRunner([self._test_run], arguments)
        result = next(iter(runner.run().values()))
        if isinstance(result, FailResult):
            raise LaunchTestError(result.message)
        problems = [*result.errors, *result.failures]
        problems += [
            (test, "unexpected success") for test in result.unexpectedSuccesses
        ]
        if problems:
            raise LaunchTestError("\n".join(_described(problems)))
        if result.testsRun and len(result.skipped) == result.testsRun:
            pytest.skip("; ".join(reason for _, reason in result.skipped))

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        if isinstance(excinfo.value, LaunchTestError):
            return str(excinfo.value)
        return super().repr_failure(excinfo)


def _described(problems: list[tuple[unittest.TestCase, str]]) -> Iterator[str]:
    for test, trace in problems:
        yield f"{test}\n{trace}"


class LaunchTestModule(pytest.File):
    """A file with ``generate_test_description``."""

    def collect(self) -> Iterator[LaunchTestItem]:
        spec = importlib.util.spec_from_file_location(self.path.stem, self.path)
        assert spec is not None, "a Python file"
        assert spec.loader is not None, "a Python file"
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        for run in LoadTestsFromPythonModule(module, name=self.path.stem):
            yield LaunchTestItem.from_parent(self, name=str(run), run=run)


def is_launch_test(path: Path) -> bool:
    """Whether a file defines a test description."""
    text = path.read_text("utf-8", errors="replace")
    return re.search(rf"^def {FUNCTION}\(", text, re.MULTILINE) is not None
