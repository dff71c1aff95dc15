"""Action that requests a sequence of transitions of lifecycle nodes."""

from collections.abc import Callable, Sequence
from typing import Any

from navette.msgs.lifecycle_msgs.msg import Transition
from navette.ros2.packages.launch import Action, Event, LaunchDescriptionEntity
from navette.ros2.packages.launch.actions import EmitEvent, RegisterEventHandler
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch.event_handler import CallbackHandler
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.logging import get_logger
from navette.ros2.packages.launch.substitution import Parts
from navette.ros2.packages.launch_ros.events.lifecycle import (
    TRANSITIONS,
    ChangeState,
    StateTransition,
    matches_node_name,
)

_GOALS = {
    Transition.TRANSITION_CONFIGURE: ("configuring", "inactive"),
    Transition.TRANSITION_CLEANUP: ("cleaningup", "unconfigured"),
    Transition.TRANSITION_ACTIVATE: ("activating", "active"),
    Transition.TRANSITION_DEACTIVATE: ("deactivating", "inactive"),
    Transition.TRANSITION_UNCONFIGURED_SHUTDOWN: ("shuttingdown", "finalized"),
    Transition.TRANSITION_INACTIVE_SHUTDOWN: ("shuttingdown", "finalized"),
    Transition.TRANSITION_ACTIVE_SHUTDOWN: ("shuttingdown", "finalized"),
}
"""Transition → its transition state and its goal state."""
_log = get_logger("launch")


class LifecycleTransition(Action):
    """Requests transitions of each node, one after another.

    The sequence of a node ends if a transition does not reach its goal state.
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
                "LifecycleTransition: expected lifecycle_node_names and transition_ids"
            )
        self._names = [Parts.of(name) for name in lifecycle_node_names]
        self._ids = [
            Parts.of(str(given) if isinstance(given, int) else given)
            for given in transition_ids
        ]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        numbers = [_number(text.perform(context)) for text in self._ids]
        return [
            entity
            for parts in self._names
            for entity in _TransitionSequence(
                parts.perform(context), numbers
            ).next_request()
        ]


class _TransitionSequence:
    """Remaining transitions of one node."""

    def __init__(self, name: str, transitions: list[int]) -> None:
        self._name = name
        self._matches: Callable[[Any], bool] = matches_node_name(name)
        self._remaining = list(transitions)

    def next_request(self) -> list[LaunchDescriptionEntity]:
        """Return what requests the next transition and waits for its end."""
        if not self._remaining:
            return []
        number = self._remaining.pop(0)
        transition_state, goal = _GOALS[number]
        handler = CallbackHandler(
            matcher=lambda event: self._is_end(event, transition_state),
            callback=lambda event, context: self._on_end(event, goal, number),
            handle_once=True,
        )
        request = ChangeState(
            lifecycle_node_matcher=self._matches, transition_id=number
        )
        return [RegisterEventHandler(handler), EmitEvent(event=request)]

    def _is_end(self, event: Event, transition_state: str) -> bool:
        return (
            isinstance(event, StateTransition)
            and self._matches(event.action)
            and event.start_state == transition_state
        )

    def _on_end(
        self, event: Any, goal: str, number: int
    ) -> list[LaunchDescriptionEntity]:
        if event.goal_state == goal:
            return self.next_request()
        _log.error(
            "%s: %s ended in %s instead of %s; no more transitions",
            self._name,
            TRANSITIONS[number],
            event.goal_state,
            goal,
        )
        return []


def _number(text: str) -> int:
    if not text.isdigit() or int(text) not in _GOALS:
        known = ", ".join(f"{TRANSITIONS[i]}: {i}" for i in _GOALS)
        raise InvalidLaunchValueError(
            f"LifecycleTransition: transition {text!r}; known: {known}"
        )
    return int(text)
