"""Handlers of events about processes and about the launch itself."""

from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import CallbackHandler, EventHandler
from navette.ros2.packages.launch.events import (
    ExecutionComplete,
    IncludeLaunchDescription,
    Shutdown,
)
from navette.ros2.packages.launch.events.process import (
    ProcessExited,
    ProcessIO,
    ProcessStarted,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    caller_location,
)

__all__ = [
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnIncludeLaunchDescription",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
    "event_named",
]


class OnActionEventBase(CallbackHandler):
    """Handler of events of one action, of selected actions, or of all.

    Args:
        action_matcher: the action, ``matcher(action) -> bool``, or None for all.
        on_event: entities, or ``on_event(event, context)`` that returns entities.
        target_event_cls: class of the events.
        target_action_cls: class of the actions.
    """

    def __init__(
        self,
        *,
        action_matcher: Any = None,
        on_event: Any,
        target_event_cls: type[Event],
        target_action_cls: type = LaunchDescriptionEntity,
        handle_once: bool = False,
    ) -> None:
        self.origin = caller_location()
        is_action = isinstance(action_matcher, LaunchDescriptionEntity)
        if not (action_matcher is None or is_action or callable(action_matcher)):
            raise InvalidLaunchValueError(
                f"{type(self).__name__}: target_action {action_matcher!r}: expected an "
                "action such as a Node, or a function of an action"
            )

        def matches(event: Event) -> bool:
            if not isinstance(event, target_event_cls):
                return False
            action = getattr(event, "action", None)
            if not isinstance(action, target_action_cls):
                return False
            if callable(action_matcher):
                return bool(action_matcher(action))
            return action_matcher is None or action is action_matcher

        super().__init__(matcher=matches, callback=on_event, handle_once=handle_once)


class OnProcessStart(OnActionEventBase):
    """Handler of the start of a process."""

    def __init__(
        self, *, target_action: Any = None, on_start: Any, handle_once: bool = False
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            handle_once=handle_once,
        )


class OnProcessExit(OnActionEventBase):
    """Handler of the exit of a process."""

    def __init__(
        self, *, target_action: Any = None, on_exit: Any, handle_once: bool = False
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_exit,
            target_event_cls=ProcessExited,
            handle_once=handle_once,
        )


class OnExecutionComplete(OnActionEventBase):
    """Handler of the completion of an action."""

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_completion: Any,
        handle_once: bool = False,
    ) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_completion,
            target_event_cls=ExecutionComplete,
            handle_once=handle_once,
        )


IoCallback = Callable[[ProcessIO], Any]


class OnProcessIO(OnActionEventBase):
    """Handler of output; each function gets the event, with ``.text`` as bytes."""

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdin: IoCallback | None = None,
        on_stdout: IoCallback | None = None,
        on_stderr: IoCallback | None = None,
        handle_once: bool = False,
    ) -> None:
        callbacks = (on_stdin, on_stdout, on_stderr)

        def on_event(event: ProcessIO, context: LaunchContext) -> Any:
            callback = callbacks[event.fd]
            return callback(event) if callback else None

        super().__init__(
            action_matcher=target_action,
            on_event=on_event,
            target_event_cls=ProcessIO,
            handle_once=handle_once,
        )


class OnShutdown(CallbackHandler):
    """Handler of the end of the launch; ``on_shutdown(event, context)`` or entities."""

    def __init__(self, *, on_shutdown: Any, handle_once: bool = False) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, Shutdown),
            callback=on_shutdown,
            handle_once=handle_once,
        )


class OnIncludeLaunchDescription(EventHandler):
    """Handler that visits the launch description of an event."""

    def __init__(self, *, handle_once: bool = False) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, IncludeLaunchDescription),
            handle_once=handle_once,
        )

    def handle(self, event: Event, context: Any) -> Any:
        super().handle(event, context)
        return [event.launch_description]  # type: ignore[attr-defined] # by the matcher


def event_named(name: str) -> Callable[[Event], bool]:
    """Return a matcher of events by name (``launch.events.Shutdown``)."""
    return lambda event: event.name == name
