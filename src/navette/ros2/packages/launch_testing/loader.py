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


class _Suite(unittest.TestSuite):
    """Suite that keeps its cases after they have run: reports list them."""

    _cleanup = False


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
        self.pre_shutdown_tests = _Suite(pre_shutdown_tests)
        self.post_shutdown_tests = _Suite(post_shutdown_tests)
        self._describe = test_description_function
        timeout = getattr(self._describe, "__ready_to_test_action_timeout__", None)
        self.timeout = DEFAULT_READY_TIMEOUT_S if timeout is None else float(timeout)
        self.markers: dict[str, Any] = getattr(self._describe, "__markers__", {})
        self._name_cases()

    def _name_cases(self) -> None:
        """Append the parameters to the names of the cases."""
        for case in self.all_cases() if self.param_args else ():
            name = f"{case._testMethodName}{self._format_params()}"
            setattr(case, name, getattr(case, case._testMethodName))
            case._testMethodName = name

    def _format_params(self) -> str:
        words = map(str, self.param_args.values())
        return f"[{', '.join(words)}]" if self.param_args else ""

    def __str__(self) -> str:
        return self.name + self._format_params()

    def check_signature(self) -> None:
        """Check that the description's function has the parameters, and no others.

        Raises:
            TypeError: names the argument.
        """
        function = inspect.unwrap(self._describe)
        taken = inspect.signature(function).parameters
        for name in self.param_args:
            if name not in taken:
                raise TypeError(
                    f"Could not find an argument {name!r} of {FUNCTION}() for "
                    f"parametrize; it has {', '.join(taken) or 'none'}"
                )
        for name, parameter in taken.items():
            if name in self.param_args or name == "ready_fn":
                continue
            if parameter.default is parameter.empty:
                raise TypeError(
                    f"{FUNCTION}() has unexpected extra argument {name!r}; "
                    "@launch_testing.parametrize() sets arguments"
                )

    def normalized_test_description(
        self, *, ready_fn: Callable[[], Any]
    ) -> tuple[LaunchDescription, dict[str, Any]]:
        """Return a new description and the objects for its tests.

        Args:
            ready_fn: called by the description's ReadyToTest, or passed to the function
                where it has this argument.

        Raises:
            ValueError: the description has not exactly one ReadyToTest.
        """
        takes_ready = "ready_fn" in inspect.signature(self._describe).parameters
        result = self._describe(**({"ready_fn": ready_fn} if takes_ready else {}))
        description, context = result if isinstance(result, tuple) else (result, {})
        if not takes_ready:
            find_ready_action(description)._add_callback(ready_fn)
        return description, dict(context)

    def get_launch_description(self) -> LaunchDescription:
        """Return a description to look into, not to launch."""
        return self.normalized_test_description(ready_fn=lambda: None)[0]

    def all_cases(self) -> Iterator[Any]:
        """Yield the test cases beside the launch, then those after it."""
        yield from iterate_tests(self.pre_shutdown_tests)
        yield from iterate_tests(self.post_shutdown_tests)

    def bind(
        self,
        tests: Iterable[Any],
        injected_attributes: Mapping[str, Any],
        injected_args: Mapping[str, Any],
    ) -> None:
        """Give values to tests.

        Args:
            injected_attributes: attributes of the test cases (``self.proc_info``).
            injected_args: arguments of the tests' methods, by name.
        """
        given = {**injected_args, **self.param_args}
        for test in iterate_tests(tests):
            vars(test).update(injected_attributes)
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
            f"{FUNCTION}() must return a LaunchDescription containing a ReadyToTest "
            f"action, launch_testing.actions.ReadyToTest(); this one has {len(found)}"
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
    loader.suiteClass = _Suite
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
        type(
            each.__name__,
            (each,),
            {"__module__": each.__module__, "__qualname__": each.__qualname__},
        )
        for each in classes
    ]
    return _Suite(map(loader.loadTestsFromTestCase, own))
