"""States of a managed node and the transitions between them.

https://design.ros2.org/articles/node_lifecycle.html; ids and labels as in rcl_lifecycle
(lifecycle_msgs/msg/State, Transition).
"""

from enum import IntEnum
from typing import NamedTuple

from navette.msgs.lifecycle_msgs.msg import State, Transition
from navette.runtime.exceptions import RCLError


class TransitionCallbackReturn(IntEnum):
    """Result of a transition's callback."""

    SUCCESS = Transition.TRANSITION_CALLBACK_SUCCESS
    FAILURE = Transition.TRANSITION_CALLBACK_FAILURE
    ERROR = Transition.TRANSITION_CALLBACK_ERROR

    def to_label(self) -> str:
        """Return the label of the next transition."""
        return f"transition_{self.name.lower()}"


class LifecycleState(NamedTuple):
    """A state, as passed to the callbacks."""

    label: str
    state_id: int


class TransitionDefinition(NamedTuple):
    """A transition between two states."""

    id: int
    label: str
    start: LifecycleState
    goal: LifecycleState


_LABELS = {
    State.PRIMARY_STATE_UNKNOWN: "unknown",
    State.PRIMARY_STATE_UNCONFIGURED: "unconfigured",
    State.PRIMARY_STATE_INACTIVE: "inactive",
    State.PRIMARY_STATE_ACTIVE: "active",
    State.PRIMARY_STATE_FINALIZED: "finalized",
    State.TRANSITION_STATE_CONFIGURING: "configuring",
    State.TRANSITION_STATE_CLEANINGUP: "cleaningup",
    State.TRANSITION_STATE_SHUTTINGDOWN: "shuttingdown",
    State.TRANSITION_STATE_ACTIVATING: "activating",
    State.TRANSITION_STATE_DEACTIVATING: "deactivating",
    State.TRANSITION_STATE_ERRORPROCESSING: "errorprocessing",
}
STATES = {label: LifecycleState(label, state_id) for state_id, label in _LABELS.items()}

# Requests: id, label, start state, transition state.
_REQUESTS = (
    (Transition.TRANSITION_CONFIGURE, "configure", "unconfigured", "configuring"),
    (Transition.TRANSITION_CLEANUP, "cleanup", "inactive", "cleaningup"),
    (Transition.TRANSITION_ACTIVATE, "activate", "inactive", "activating"),
    (Transition.TRANSITION_DEACTIVATE, "deactivate", "active", "deactivating"),
    (
        Transition.TRANSITION_UNCONFIGURED_SHUTDOWN,
        "shutdown",
        "unconfigured",
        "shuttingdown",
    ),
    (Transition.TRANSITION_INACTIVE_SHUTDOWN, "shutdown", "inactive", "shuttingdown"),
    (Transition.TRANSITION_ACTIVE_SHUTDOWN, "shutdown", "active", "shuttingdown"),
)
# Outcomes: id of the first, transition state, next states (success, failure, error).
_OUTCOMES = (
    (10, "configuring", ("inactive", "unconfigured", "errorprocessing")),
    (20, "cleaningup", ("unconfigured", "inactive", "errorprocessing")),
    (30, "activating", ("active", "inactive", "errorprocessing")),
    (40, "deactivating", ("inactive", "active", "errorprocessing")),
    (50, "shuttingdown", ("finalized", "finalized", "errorprocessing")),
    (60, "errorprocessing", ("unconfigured", "finalized", "finalized")),
)
TRANSITIONS: tuple[TransitionDefinition, ...] = (
    *(
        TransitionDefinition(number, label, STATES[start], STATES[goal])
        for number, label, start, goal in _REQUESTS
    ),
    *(
        TransitionDefinition(base + i, outcome.to_label(), STATES[start], STATES[goal])
        for base, start, goals in _OUTCOMES
        for i, (outcome, goal) in enumerate(
            zip(TransitionCallbackReturn, goals, strict=True)
        )
    ),
)


class LifecycleStateMachine:
    """Current state and the transitions that are available in it."""

    def __init__(self) -> None:
        self.state = STATES["unconfigured"]

    @property
    def available_transitions(self) -> list[TransitionDefinition]:
        return [each for each in TRANSITIONS if each.start == self.state]

    def by_label(self, label: str) -> TransitionDefinition:
        """Return the transition with that label from the current state.

        Raises:
            RCLError: unknown transition; lists the available ones.
        """
        for each in self.available_transitions:
            if each.label == label:
                return each
        raise RCLError(self._error_text(repr(label)))

    def by_id(self, transition_id: int) -> TransitionDefinition:
        """Return the transition with that id; raise as :meth:`by_label`."""
        for each in self.available_transitions:
            if each.id == transition_id:
                return each
        raise RCLError(self._error_text(str(transition_id)))

    def _error_text(self, requested: str) -> str:
        known = [f"{each.label} ({each.id})" for each in self.available_transitions]
        return (
            f"no transition {requested} from state {self.state.label}; available: "
            f"{', '.join(known) or 'none'}"
        )
