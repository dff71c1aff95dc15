"""Conditions: whether an action is executed."""

from collections.abc import Callable

from navette.ros2.packages.launch.launch_context import LaunchContext


class Condition:
    """Condition that a function evaluates; without one it never holds."""

    def __init__(
        self, *, predicate: Callable[[LaunchContext], bool] | None = None
    ) -> None:
        self._predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether to execute the action; called once per execution."""
        return self._predicate is not None and self._predicate(context)

    def describe(self) -> str:
        """Describe the condition in a listing."""
        return f"{type(self).__name__}({self._predicate!r})"
