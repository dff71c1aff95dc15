"""Results of test runs as a JUnit report."""

from collections.abc import Mapping
from typing import Any
from xml.etree.ElementTree import Element, ElementTree, SubElement

__all__ = ["unittestCaseToXml", "unittestResultToXml", "unittestResultsToXml"]


def unittestResultsToXml(  # noqa: N802 - ROS 2's name
    *, name: str = "launch_test", test_results: Mapping[Any, Any]
) -> "ElementTree[Element]":
    """Return the report: one suite for each run.

    Args:
        test_results: results with ``testCases`` and ``testTimes``, by run.
    """
    results = list(test_results.values())
    root = Element(
        "testsuites",
        name=name,
        tests=str(sum(each.testsRun for each in results)),
        failures=str(sum(len(each.failures) for each in results)),
        errors=str(sum(len(each.errors) for each in results)),
        time=_seconds(sum(sum(each.testTimes.values()) for each in results)),
    )
    for run, result in test_results.items():
        root.append(unittestResultToXml(str(run), result))
    return ElementTree(root)


def unittestResultToXml(name: str, test_result: Any) -> Element:  # noqa: N802 - ROS 2's name
    """Return the suite of one run."""
    suite = Element(
        "testsuite",
        name=name,
        tests=str(test_result.testsRun),
        failures=str(len(test_result.failures)),
        errors=str(len(test_result.errors)),
        skipped=str(len(test_result.skipped)),
        time=_seconds(sum(test_result.testTimes.values())),
    )
    for case in test_result.testCases:
        suite.append(unittestCaseToXml(test_result, case))
    return suite


def unittestCaseToXml(test_result: Any, test_case: Any) -> Element:  # noqa: N802 - ROS 2's name
    """Return one test case; failures, errors and skips are elements inside."""
    # The parameters of a run follow the method's name: they may contain dots.
    method, _, parameters = test_case.id().partition("[")
    classname, _, name = method.rpartition(".")
    element = Element(
        "testcase",
        classname=classname,
        name=f"{name}[{parameters}" if parameters else name,
        time=_seconds(test_result.testTimes[test_case]),
    )
    for tag, entries in (
        ("failure", test_result.failures),
        ("error", test_result.errors),
        ("skipped", test_result.skipped),
    ):
        for case, message in entries:
            if case is test_case:
                SubElement(element, tag, message=message)
    return element


def _seconds(time_s: float) -> str:
    return str(round(time_s, 3))
