"""Conditions: whether an action is executed."""

from collections.abc import Callable

from navette.ros2.packages.launch.launch_context import LaunchContext


class Condition:
    """Condition that a function evaluates."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool]) -> None:
        self._predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether to execute the action; called once per execution."""
        return self._predicate(context)
