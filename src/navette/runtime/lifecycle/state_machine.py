"""The states of a managed node and the transitions between them.

https://design.ros2.org/articles/node_lifecycle.html; ids and labels as in rcl_lifecycle
(lifecycle_msgs/msg/State, Transition).
"""

from enum import IntEnum
from typing import NamedTuple

from navette.msgs.lifecycle_msgs.msg import State, Transition
from navette.runtime.exceptions import RCLError


class TransitionCallbackReturn(IntEnum):
    """What a transition's callback says."""

    SUCCESS = Transition.TRANSITION_CALLBACK_SUCCESS
    FAILURE = Transition.TRANSITION_CALLBACK_FAILURE
    ERROR = Transition.TRANSITION_CALLBACK_ERROR

    def to_label(self) -> str:
        """Label of the transition that follows."""
        return f"transition_{self.name.lower()}"


class LifecycleState(NamedTuple):
    """A state, as the callbacks get it."""

    label: str
    state_id: int


class LifecycleTransition(NamedTuple):
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

# Request: id, label, start, while under way. Then where success, failure and error
# lead; their ids count from the id beside them.
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
_OUTCOMES = (
    (10, "configuring", ("inactive", "unconfigured", "errorprocessing")),
    (20, "cleaningup", ("unconfigured", "inactive", "errorprocessing")),
    (30, "activating", ("active", "inactive", "errorprocessing")),
    (40, "deactivating", ("inactive", "active", "errorprocessing")),
    (50, "shuttingdown", ("finalized", "finalized", "errorprocessing")),
    (60, "errorprocessing", ("unconfigured", "finalized", "finalized")),
)
TRANSITIONS: tuple[LifecycleTransition, ...] = (
    *(
        LifecycleTransition(number, label, STATES[start], STATES[goal])
        for number, label, start, goal in _REQUESTS
    ),
    *(
        LifecycleTransition(base + i, outcome.to_label(), STATES[start], STATES[goal])
        for base, start, goals in _OUTCOMES
        for i, (outcome, goal) in enumerate(
            zip(TransitionCallbackReturn, goals, strict=True)
        )
    ),
)


class LifecycleStateMachine:
    """The present state, and where one can go from it."""

    def __init__(self) -> None:
        self.state = STATES["unconfigured"]

    @property
    def available_transitions(self) -> list[LifecycleTransition]:
        return [each for each in TRANSITIONS if each.start == self.state]

    def by_label(self, label: str) -> LifecycleTransition:
        """The transition of that label from the present state.

        Raises:
            RCLError: there is none; lists those there are.
        """
        for each in self.available_transitions:
            if each.label == label:
                return each
        raise RCLError(self._refusal(repr(label)))

    def by_id(self, transition_id: int) -> LifecycleTransition:
        """The transition of that id; raises as :meth:`by_label`."""
        for each in self.available_transitions:
            if each.id == transition_id:
                return each
        raise RCLError(self._refusal(str(transition_id)))

    def _refusal(self, wanted: str) -> str:
        known = [f"{each.label} ({each.id})" for each in self.available_transitions]
        return (
            f"no transition {wanted} from state {self.state.label}; available: "
            f"{', '.join(known) or 'none'}"
        )
