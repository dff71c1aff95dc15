"""Results of test runs, with the test cases that ran and their times."""

import time
import unittest
from collections.abc import Iterable
from typing import Any, Protocol


def _now_s() -> float:
    return time.monotonic()  # noqa: TID251 - the report has real durations


class HasCases(Protocol):
    """A test run."""

    def all_cases(self) -> Iterable[Any]: ...


class TestResult(unittest.TextTestResult):
    """Result that records which cases ran and for how long."""

    __test__ = False  # not a class of pytest's

    def __init__(
        self, stream: Any = None, descriptions: Any = None, verbosity: Any = None
    ) -> None:
        self._starts_s: dict[Any, float] = {}
        self._times_s: dict[Any, float] = {}
        super().__init__(stream, descriptions, verbosity)

    @property
    def testCases(self) -> list[Any]:  # noqa: N802 - ROS 2's name
        """The cases that were started."""
        return list(self._starts_s)

    @property
    def testTimes(self) -> dict[Any, float]:  # noqa: N802 - ROS 2's name
        """Seconds that each case took."""
        return {case: self._times_s.get(case, 0.0) for case in self._starts_s}

    def startTest(self, test: unittest.TestCase) -> None:  # noqa: N802 - unittest's name
        self._starts_s[test] = _now_s()
        super().startTest(test)

    def stopTest(self, test: unittest.TestCase) -> None:  # noqa: N802 - unittest's name
        self._times_s[test] = _now_s() - self._starts_s[test]
        super().stopTest(test)

    def append(self, results: "TestResult") -> None:
        """Add the cases of another result."""
        self._starts_s |= results._starts_s
        self._times_s |= results._times_s
        self.testsRun += results.testsRun
        self.failures += results.failures
        self.errors += results.errors
        self.skipped += results.skipped
        self.expectedFailures += results.expectedFailures
        self.unexpectedSuccesses += results.unexpectedSuccesses


class _UniformResult(unittest.TestResult):
    """Result of a run whose cases did not run, all for one reason."""

    def __init__(self, test_run: HasCases) -> None:
        super().__init__()
        self.testCases = list(test_run.all_cases())
        self.testTimes = dict.fromkeys(self.testCases, 0.0)
        self.testsRun = len(self.testCases)


class FailResult(_UniformResult):
    """Result of a run whose launch ended before the tests; all cases have failed."""

    def __init__(self, test_run: HasCases, message: str) -> None:
        super().__init__(test_run)
        self.message = message
        for case in self.testCases:
            self.failures.append((case, message))

    def wasSuccessful(self) -> bool:  # noqa: N802 - unittest's name
        return False  # also without any case


class SkipResult(_UniformResult):
    """Result of a run that was skipped."""

    def __init__(self, test_run: HasCases, skip_reason: str = "") -> None:
        super().__init__(test_run)
        for case in self.testCases:
            self.addSkip(case, skip_reason)
