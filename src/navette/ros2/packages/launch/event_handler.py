"""Event handlers: what a launch does when an event happens."""

from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    normalize_to_list_of_entities,
)


class EventHandler:
    """Visits entities when a matching event happens.

    Args:
        matcher: whether to handle an event.
        entities: what to visit; or override :meth:`handle`.
        handle_once: unregister after the first matching event.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: Any = None,
        handle_once: bool = False,
    ) -> None:
        self._matcher = matcher
        if isinstance(entities, (list, tuple)):
            self.entities: list[Any] = list(entities)  # checked when they are visited
        else:
            self.entities = normalize_to_list_of_entities(entities)
        self.handle_once = handle_once

    def matches(self, event: Event) -> bool:
        """Return whether to call :meth:`handle` with this event."""
        return self._matcher(event)

    def handle(self, event: Event, context: LaunchContext) -> Any:
        """Return the entities to visit; ``context.locals.event`` is the event."""
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return list(self.entities)

    def describe(self) -> str:
        """Describe the handler in an error message."""
        return type(self).__name__


class CallbackHandler(EventHandler):
    """Visits entities, or what a function returns for the event.

    Args:
        matcher: whether to handle an event.
        callback: entities, or ``callback(event, context)`` that returns entities or
            None.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        callback: Any,
        handle_once: bool = False,
    ) -> None:
        self._callback = callback if callable(callback) else None
        super().__init__(
            matcher=matcher,
            entities=None if callable(callback) else callback,
            handle_once=handle_once,
        )

    def handle(self, event: Event, context: LaunchContext) -> Any:
        entities = super().handle(event, context)
        return entities if self._callback is None else self._callback(event, context)
