"""Decorators of test descriptions and test classes."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial, update_wrapper, wraps
from typing import Any, TypeVar

_ClassT = TypeVar("_ClassT", bound=type)


def post_shutdown_test() -> Callable[[_ClassT], _ClassT]:
    """Run the tests of a class after the processes have ended."""

    def mark(cls: _ClassT) -> _ClassT:
        cls.__post_shutdown_test__ = True  # type: ignore[attr-defined] # as in ROS 2
        return cls

    return mark


def ready_to_test_action_timeout(timeout: float) -> Callable[[Any], Any]:
    """Set the seconds from the start of the launch to ReadyToTest (default: 15)."""

    def mark(function: Any) -> Any:
        function.__ready_to_test_action_timeout__ = timeout
        return function

    return mark


def parametrize(
    argnames: str | Sequence[str], argvalues: Iterable[Any]
) -> Callable[[Any], Any]:
    """Call a description's function once for each value, or tuple of values.

    Args:
        argnames: names of arguments, in one text separated by commas or as a list.
        argvalues: a value for each call; a tuple for several names.
    """
    names = argnames.split(",") if isinstance(argnames, str) else list(argnames)
    names = [name.strip() for name in names if name.strip()]
    calls_values = [each if isinstance(each, tuple) else (each,) for each in argvalues]

    def mark(function: Any) -> Any:
        @wraps(function)
        def calls() -> Iterator[tuple[Callable[..., Any], dict[str, Any]]]:
            for values in calls_values:
                arguments = dict(zip(names, values, strict=True))
                call = update_wrapper(partial(function, **arguments), function)
                yield call, arguments

        calls.__parametrized__ = True  # type: ignore[attr-defined] # as in ROS 2
        return calls

    return mark
