"""Conditions: whether an action is executed."""

from collections.abc import Callable

from navette.ros2.packages.launch.launch_context import LaunchContext


class Condition:
    """Asks ``predicate`` when the action is reached."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool]) -> None:
        self._predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        """Whether the action is executed; asked once an action."""
        return self._predicate(context)
