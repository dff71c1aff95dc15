"""Actions that emit events, register handlers, and shut the launch down."""

from collections.abc import Iterable
from typing import Any

from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import EventHandler
from navette.ros2.packages.launch.events import Shutdown as ShutdownEvent
from navette.ros2.packages.launch.events.process import ProcessExited
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
)

_log = get_logger("launch")


class RegisterEventHandler(Action):
    """Registers an event handler."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def describe(self) -> str:
        return f"RegisterEventHandler({self.event_handler.describe()})"

    def describe_conditional_sub_entities(
        self,
    ) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        return [(self.event_handler.describe(), list(self.event_handler.entities))]

    def execute(self, context: LaunchContext) -> None:
        context.register_event_handler(self.event_handler)


class UnregisterEventHandler(Action):
    """Unregisters an event handler."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        context.unregister_event_handler(self.event_handler)


class EmitEvent(Action):
    """Emits an event."""

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event = event

    def describe(self) -> str:
        return f"EmitEvent({self.event.name})"

    def execute(self, context: LaunchContext) -> None:
        context.emit_event_sync(self.event)


class Shutdown(Action):
    """Ends the launch and everything that it started."""

    def __init__(
        self, *, reason: SomeSubstitutionsType = "reason not given", **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.reason = Parts.of(reason)

    def execute(self, context: LaunchContext) -> None:
        reason = self.reason.perform(context)
        event = context.get_locals_as_dict().get("event")
        if isinstance(event, ProcessExited) and not context.is_shutdown:
            name = event.process_name
            _log.info("process[%s] was required: shutting down launched system", name)
        context.emit_event_sync(ShutdownEvent(reason=reason))
