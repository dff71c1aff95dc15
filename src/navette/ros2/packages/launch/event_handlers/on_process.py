"""Handlers for what becomes of commands."""

from collections.abc import Callable
from typing import Any

from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event import Event
from navette.ros2.packages.launch.event_handler import AnsweringHandler
from navette.ros2.packages.launch.events.execution import ExecutionComplete
from navette.ros2.packages.launch.events.process import (
    ProcessExited,
    ProcessIO,
    ProcessStarted,
)
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    caller_location,
    normalize_to_list_of_entities,
)


class OnActionEventBase(AnsweringHandler):
    """Answers events of one action, of those a function picks, or of all.

    Args:
        action_matcher: the action, ``matcher(action) -> bool``, or None for all.
        on_event: entities, or ``on_event(event, context)`` that returns some.
        target_event_cls: the kind of event.
        target_action_cls: the kind of action, where it matters.
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
                f"{type(self).__name__}: target_action {action_matcher!r}: wanted an "
                "action such as a Node, or a function of one"
            )

        def matches(event: Event) -> bool:
            if not isinstance(event, target_event_cls):
                return False
            action = getattr(event, "action", None)
            if not isinstance(action, target_action_cls):
                return False
            if action_matcher is None or is_action:
                return action_matcher is None or action is action_matcher
            return bool(action_matcher(action))

        super().__init__(matcher=matches, answer=on_event, handle_once=handle_once)


class OnProcessStart(OnActionEventBase):
    """When a command runs."""

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
    """When a command has ended."""

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
    """When an action has done all that it does."""

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


IoAnswer = Callable[[ProcessIO], Any]


class OnProcessIO(OnActionEventBase):
    """When a command writes; each function gets the event, with ``.text`` bytes."""

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdin: IoAnswer | None = None,
        on_stdout: IoAnswer | None = None,
        on_stderr: IoAnswer | None = None,
        handle_once: bool = False,
    ) -> None:
        answers = (on_stdin, on_stdout, on_stderr)

        def answer(
            event: ProcessIO, context: LaunchContext
        ) -> list[LaunchDescriptionEntity]:
            chosen = answers[event.fd]
            return normalize_to_list_of_entities(chosen(event) if chosen else None)

        super().__init__(
            action_matcher=target_action,
            on_event=answer,
            target_event_cls=ProcessIO,
            handle_once=handle_once,
        )
