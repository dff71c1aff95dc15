"""Test runs of a module: its descriptions, each with the tests of the module."""

import inspect
import unittest
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from types import ModuleType
from typing import Any

from navette.ros2.packages.launch import LaunchDescription
from navette.ros2.packages.launch.launch_description import walk
from navette.ros2.packages.launch_testing.actions import ReadyToTest

FUNCTION = "generate_test_description"
DEFAULT_READY_TIMEOUT_S = 15.0
_BOUND_METHODS = ("setUp", "tearDown")


class TestRun:
    """One launch, the tests beside it and the tests after it.

    Args:
        name: of the module.
        test_description_function: ``generate_test_description``.
        param_args: arguments of a parametrized description.
        pre_shutdown_tests, post_shutdown_tests: tests of the module.
    """

    __test__ = False  # not a class of pytest's

    def __init__(
        self,
        name: str,
        test_description_function: Callable[..., Any],
        param_args: Mapping[str, Any],
        pre_shutdown_tests: Iterable[Any],
        post_shutdown_tests: Iterable[Any],
    ) -> None:
        self.name = name
        self.param_args = dict(param_args)
        self.pre_shutdown_tests = unittest.TestSuite(pre_shutdown_tests)
        self.post_shutdown_tests = unittest.TestSuite(post_shutdown_tests)
        self._describe = test_description_function
        base = inspect.unwrap(
            getattr(test_description_function, "func", self._describe)
        )
        timeout = getattr(base, "__ready_to_test_action_timeout__", None)
        self.timeout = DEFAULT_READY_TIMEOUT_S if timeout is None else float(timeout)
        self.markers: dict[str, Any] = getattr(base, "__markers__", {})

    def __str__(self) -> str:
        words = [f"{name}={value}" for name, value in self.param_args.items()]
        return f"{self.name}[{', '.join(words)}]" if words else self.name

    def describe(
        self, on_ready: Callable[[], Any]
    ) -> tuple[LaunchDescription, dict[str, Any]]:
        """Return a new description and the objects for its tests.

        Args:
            on_ready: called by the description's ReadyToTest, or passed as the argument
                ``ready_fn`` where the function has one.

        Raises:
            ValueError: the description has not exactly one ReadyToTest.
        """
        takes_ready = "ready_fn" in inspect.signature(self._describe).parameters
        result = self._describe(**({"ready_fn": on_ready} if takes_ready else {}))
        description, context = result if isinstance(result, tuple) else (result, {})
        if not takes_ready:
            find_ready_action(description)._add_callback(on_ready)
        return description, dict(context)

    def bind(self, suite: unittest.TestSuite, values: Mapping[str, Any]) -> None:
        """Pass values to the arguments of that name of the tests' methods."""
        given = {**values, **self.param_args}
        for test in iterate_tests(suite):
            for name in (*_BOUND_METHODS, test._testMethodName):
                _bind(test, name, given)
            for name in ("setUpClass", "tearDownClass"):
                _bind(type(test), name, given)


def find_ready_action(description: LaunchDescription) -> ReadyToTest:
    """Return the description's only ReadyToTest.

    Raises:
        ValueError: there is none, or there are several.
    """
    found = [each for each in walk(description) if isinstance(each, ReadyToTest)]
    if len(found) != 1:
        raise ValueError(
            "a test description needs one launch_testing.actions.ReadyToTest(), this "
            f"one has {len(found)}"
        )
    return found[0]


def _bind(owner: Any, name: str, given: Mapping[str, Any]) -> None:
    method = getattr(owner, name)
    wanted = inspect.signature(method).parameters
    matching = {key: value for key, value in given.items() if key in wanted}
    if matching:
        setattr(owner, name, partial(method, **matching))


def iterate_tests(suite: Iterable[Any]) -> Iterator[Any]:
    """Yield the test cases of a suite and of the suites inside."""
    for each in suite:
        if isinstance(each, unittest.TestSuite):
            yield from iterate_tests(each)
        else:
            yield each


def LoadTestsFromPythonModule(  # noqa: N802 - ROS 2's name
    module: ModuleType, *, name: str = "launch_tests"
) -> list[TestRun]:
    """Return the test runs of a module, several of a parametrized description."""
    function = getattr(module, FUNCTION)
    is_parametrized = getattr(function, "__parametrized__", False)
    descriptions = list(function()) if is_parametrized else [(function, {})]
    return [
        TestRun(
            name,
            describe,
            arguments,
            _suite(module, after_shutdown=False),
            _suite(module, after_shutdown=True),
        )
        for describe, arguments in descriptions
    ]


def _suite(module: ModuleType, *, after_shutdown: bool) -> unittest.TestSuite:
    loader = unittest.TestLoader()
    classes = [
        each
        for each in vars(module).values()
        if inspect.isclass(each)
        and issubclass(each, unittest.TestCase)
        and each.__module__.partition(".")[0] != "unittest"
        and getattr(each, "__post_shutdown_test__", False) == after_shutdown
    ]
    # A class of its own for each run: what setUpClass gets belongs to one run.
    own = [
        type(each.__name__, (each,), {"__qualname__": each.__qualname__})
        for each in classes
    ]
    return unittest.TestSuite(map(loader.loadTestsFromTestCase, own))
