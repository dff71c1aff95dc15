"""Handlers for what becomes of the launch itself."""

from typing import Any

from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import AnsweringHandler, EventHandler
from navette.ros2.packages.launch.events import IncludeLaunchDescription, Shutdown
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)


class OnShutdown(AnsweringHandler):
    """When the launch ends: entities, or ``on_shutdown(event, context)``."""

    def __init__(self, *, on_shutdown: Any, handle_once: bool = False) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, Shutdown),
            answer=on_shutdown,
            handle_once=handle_once,
        )


class OnIncludeLaunchDescription(EventHandler):
    """When a description is to be visited that an event carries."""

    def __init__(self, *, handle_once: bool = False) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, IncludeLaunchDescription),
            handle_once=handle_once,
        )

    def handle(self, event: Event, context: Any) -> list[LaunchDescriptionEntity]:
        assert isinstance(event, IncludeLaunchDescription), "the matcher picked it"
        return [event.launch_description]


def event_named(name: str) -> Any:
    """A matcher for events by their name (``launch.events.Shutdown``)."""
    return lambda event: event.name == name
