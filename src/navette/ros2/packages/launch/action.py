"""Base class of actions."""

from collections.abc import Callable, Iterable
from typing import Any, TypeVar

from navette.ros2.packages.launch.condition import Condition
from navette.ros2.packages.launch.conditions import ConditionalElement, condition_of
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import ExecutionComplete
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    caller_location,
)
from navette.ros2.packages.launch.substitution import describe_first_parts

#: Class → reader of its arguments; filled by the modules of the tags.
_READERS: dict[type, Callable[[Any], dict[str, Any]]] = {}
_ReaderT = TypeVar("_ReaderT", bound=Callable[[Any], dict[str, Any]])


def reads_arguments(action: type) -> Callable[[_ReaderT], _ReaderT]:
    """Register a function that reads the arguments of a class from an element."""

    def register(reader: _ReaderT) -> _ReaderT:
        _READERS[action] = reader
        return reader

    return register


class Action(LaunchDescriptionEntity):
    """Entity that is executed when it is visited and its condition holds."""

    #: Whether the action calls :meth:`complete` itself, after :meth:`execute`.
    completes_later = False

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
        """Return the class and its arguments, read from an element of a launch file.

        Those of ExecuteProcess, Node and GroupAction are all of their tag's; those of
        other classes are ``if`` and ``unless``. Classes for ``expose_action`` add the
        arguments of their own attributes.
        """
        readers = (_READERS.get(base) for base in cls.__mro__)
        read = next(filter(None, readers), condition_of)
        return cls, dict(read(entity))

    def describe(self) -> str:
        text = describe_first_parts(self)
        return f"{type(self).__name__}({text})" if text else type(self).__name__

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities inside; they are visited if the condition holds."""
        return []

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return self.listed_entities() if self.condition is None else []

    def listed_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities inside that listings show."""
        return self.get_sub_entities()

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        inside = self.listed_entities()
        if self.condition is None or not inside:
            return []
        return [(f"if {self.condition.describe()}", inside)]

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if self.condition is not None and not self.condition.evaluate(context):
            return None
        found = self.execute(context)
        if not self.completes_later:
            self.complete(context)
        return found

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Do the work; return the entities to visit next. The default does nothing."""
        return None

    def complete(self, context: LaunchContext) -> None:
        """Emit the event of the action's completion, after its future if it has one."""
        future = self.get_asyncio_future()
        if future is None or future.done():
            self._emit_completion(context)
        else:
            future.add_done_callback(lambda _: self._emit_completion(context))

    def _emit_completion(self, context: LaunchContext) -> None:
        event = ExecutionComplete(action=self)
        if any(handler.matches(event) for handler in context.event_handlers):
            context.emit_event_sync(event)
