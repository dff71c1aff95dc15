"""The action that takes managed nodes through transitions, one after the other."""

from collections.abc import Callable, Sequence
from typing import Any

from navette.msgs.lifecycle_msgs.msg import Transition
from navette.ros2.packages.launch import Action, Event
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event_handler import AnsweringHandler, EventHandler
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.substitution import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from navette.ros2.packages.launch_ros.events.lifecycle import (
    ChangeState,
    StateTransition,
    matches_node_name,
)
from navette.ros2.packages.launch_ros.events.lifecycle.change_state import TRANSITIONS

_GOALS = {
    Transition.TRANSITION_CONFIGURE: ("configuring", "inactive"),
    Transition.TRANSITION_CLEANUP: ("cleaningup", "unconfigured"),
    Transition.TRANSITION_ACTIVATE: ("activating", "active"),
    Transition.TRANSITION_DEACTIVATE: ("deactivating", "inactive"),
    Transition.TRANSITION_UNCONFIGURED_SHUTDOWN: ("shuttingdown", "finalized"),
    Transition.TRANSITION_INACTIVE_SHUTDOWN: ("shuttingdown", "finalized"),
    Transition.TRANSITION_ACTIVE_SHUTDOWN: ("shuttingdown", "finalized"),
}
"""Transition → the state on the way, and the one at its end."""
_log = get_logger("launch")


class LifecycleTransition(Action):
    """Each node is asked for the next transition once it has made the one before.

    One that goes elsewhere (an error) is asked for no more.
    """

    def __init__(
        self,
        *,
        lifecycle_node_names: Sequence[Any],
        transition_ids: Sequence[Any],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not transition_ids or not lifecycle_node_names:
            raise InvalidLaunchValueError(
                "LifecycleTransition: wanted lifecycle_node_names and transition_ids"
            )
        self._names = [
            normalize_to_list_of_substitutions(name) for name in lifecycle_node_names
        ]
        self._ids = [
            normalize_to_list_of_substitutions(
                str(given) if isinstance(given, int) else given
            )
            for given in transition_ids
        ]

    def execute(self, context: LaunchContext) -> None:
        numbers = [_number(perform_substitutions(context, text)) for text in self._ids]
        for parts in self._names:
            _Way(context, perform_substitutions(context, parts), numbers).go_on()


class _Way:
    """The transitions of one node that are still to come."""

    def __init__(
        self, context: LaunchContext, name: str, transitions: list[int]
    ) -> None:
        self._context = context
        self._name = name
        self._is_it: Callable[[Any], bool] = matches_node_name(name)
        self._left = list(transitions)
        self._handler: EventHandler | None = None

    def go_on(self) -> None:
        """Ask for the next, if there is one."""
        if not self._left:
            return
        number = self._left.pop(0)
        on_the_way, goal = _GOALS[number]
        self._handler = AnsweringHandler(
            matcher=lambda event: self._is_end(event, on_the_way),
            answer=lambda event, context: self._arrived(event, goal, number),
            handle_once=True,
        )
        self._context.register_event_handler(self._handler)
        self._context.emit_event(
            ChangeState(lifecycle_node_matcher=self._is_it, transition_id=number)
        )

    def _is_end(self, event: Event, on_the_way: str) -> bool:
        return (
            isinstance(event, StateTransition)
            and self._is_it(event.action)
            and event.start_state == on_the_way
        )

    def _arrived(self, event: Any, goal: str, number: int) -> None:
        if event.goal_state == goal:
            self.go_on()
        else:
            _log.error(
                "%s: %s ended in %s instead of %s; no more transitions",
                self._name,
                TRANSITIONS[number],
                event.goal_state,
                goal,
            )


def _number(text: str) -> int:
    if not text.isdigit() or int(text) not in _GOALS:
        known = ", ".join(f"{TRANSITIONS[i]}: {i}" for i in _GOALS)
        raise InvalidLaunchValueError(
            f"LifecycleTransition: transition {text!r}; known: {known}"
        )
    return int(text)
