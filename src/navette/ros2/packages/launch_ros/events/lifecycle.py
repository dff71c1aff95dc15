"""Events of lifecycle nodes: requested and observed transitions."""

from collections.abc import Callable
from typing import Any

from navette.msgs.lifecycle_msgs.msg import Transition
from navette.ros2.packages.launch import Event
from navette.ros2.packages.launch.errors import InvalidLaunchValueError
from navette.ros2.packages.launch_ros.events.matchers import matches_node_name

__all__ = ["TRANSITIONS", "ChangeState", "StateTransition", "matches_node_name"]

TRANSITIONS = {
    getattr(Transition, name): name
    for name in (
        "TRANSITION_CREATE",
        "TRANSITION_CONFIGURE",
        "TRANSITION_CLEANUP",
        "TRANSITION_ACTIVATE",
        "TRANSITION_DEACTIVATE",
        "TRANSITION_UNCONFIGURED_SHUTDOWN",
        "TRANSITION_INACTIVE_SHUTDOWN",
        "TRANSITION_ACTIVE_SHUTDOWN",
        "TRANSITION_DESTROY",
    )
}
"""Transition id → name."""


class ChangeState(Event):
    """Request to the lifecycle nodes whose actions the matcher selects."""

    name = "launch_ros.events.lifecycle.ChangeState"
    valid_transitions = TRANSITIONS

    def __init__(
        self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int
    ) -> None:
        if transition_id not in TRANSITIONS:
            known = ", ".join(f"{name}: {i}" for i, name in TRANSITIONS.items())
            raise InvalidLaunchValueError(
                f"ChangeState: transition_id {transition_id!r}; known: {known}"
            )
        self.lifecycle_node_matcher = lifecycle_node_matcher
        self.transition_id = transition_id


class StateTransition(Event):
    """A lifecycle node changed its state.

    ``action`` is the LifecycleNode, ``msg`` its TransitionEvent.
    """

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        self.action = action
        self.msg = msg

    @property
    def timestamp(self) -> int:
        return int(self.msg.timestamp)

    @property
    def transition(self) -> str:
        return str(self.msg.transition.label)

    @property
    def start_state(self) -> str:
        return str(self.msg.start_state.label)

    @property
    def goal_state(self) -> str:
        return str(self.msg.goal_state.label)
