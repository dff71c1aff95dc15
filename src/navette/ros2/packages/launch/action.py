"""Base class of actions."""

from typing import Any

from navette.ros2.packages.launch.condition import Condition
from navette.ros2.packages.launch.conditions import ConditionalElement, condition_of
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    caller_location,
)
from navette.ros2.packages.launch.substitution import describe_first_parts


class Action(LaunchDescriptionEntity):
    """Entity that is executed when it is visited and its condition holds."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        if condition is not None and not isinstance(condition, Condition):
            raise InvalidLaunchValueError(
                f"{type(self).__name__}: condition {condition!r}: expected a condition "
                "such as IfCondition(…)"
            )
        self.condition = condition
        self.origin = caller_location()

    @classmethod
    def parse(
        cls, entity: ConditionalElement, parser: object
    ) -> tuple[type["Action"], dict[str, Any]]:
        """Return the class and its arguments by the attributes ``if`` and ``unless``.

        Classes for ``expose_action`` add the arguments of their own attributes.
        """
        return cls, dict(condition_of(entity))

    def describe(self) -> str:
        text = describe_first_parts(self)
        return f"{type(self).__name__}({text})" if text else type(self).__name__

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if self.condition is None or self.condition.evaluate(context):
            return self.execute(context)
        return None

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Do the work; return the entities to visit next. The default does nothing."""
        return None
