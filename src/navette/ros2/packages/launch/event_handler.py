"""Event handlers: what a launch does when something happens."""

from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    normalize_to_list_of_entities,
)


class EventHandler:
    """Answers the events that ``matcher`` picks with entities to visit.

    Args:
        matcher: whether an event is meant.
        entities: what to visit then; or override :meth:`handle`.
        handle_once: leave after the first event that matched.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: Any = None,
        handle_once: bool = False,
    ) -> None:
        self._matcher = matcher
        self.entities = normalize_to_list_of_entities(entities)
        self.handle_once = handle_once

    def matches(self, event: Event) -> bool:
        """Whether :meth:`handle` is to be called with this event."""
        return self._matcher(event)

    def handle(
        self, event: Event, context: LaunchContext
    ) -> list[LaunchDescriptionEntity]:
        """What to visit now that the event happened."""
        return list(self.entities)

    def describe(self) -> str:
        """How it reads in an error."""
        return type(self).__name__


class AnsweringHandler(EventHandler):
    """Answers with entities, or with what a function makes of the event.

    Args:
        matcher: whether an event is meant.
        answer: entities, or ``answer(event, context)`` that returns entities or None.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        answer: Any,
        handle_once: bool = False,
    ) -> None:
        self._answer = answer if callable(answer) else None
        super().__init__(
            matcher=matcher,
            entities=None if callable(answer) else answer,
            handle_once=handle_once,
        )

    def handle(
        self, event: Event, context: LaunchContext
    ) -> list[LaunchDescriptionEntity]:
        if self._answer is None:
            return super().handle(event, context)
        return normalize_to_list_of_entities(self._answer(event, context))
